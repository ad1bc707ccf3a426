#pragma once

#include "mbs_export/modal_body.hpp"
#include "report/json.hpp"
#include "report/page/mode_looks.hpp"

namespace chladni::report {

/// The modes of a body: number, frequency, kind, what they look like where `looks` knows, and for
/// modes that the certificate knows the estimated relative error of the frequency and half the
/// bound of the error of omega^2.
Json modes_json(const mbs_export::ModalBody& body, const mbs_export::Certificate& certificate,
                const ModeLooks& looks);

/// The eigenvalue counts of the certificate: upper limit, expected and found number; null when none
/// were counted.
Json counts_json(const mbs_export::Certificate& certificate);

/// Size and error for each step of the selection; null when no tolerance chose the modes.
Json selection_json(const mbs_export::ModalBody& body);

}  // namespace chladni::report
