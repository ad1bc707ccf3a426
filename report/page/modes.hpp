#pragma once

#include <map>

#include "mbs_export/modal_body.hpp"
#include "report/json.hpp"

namespace chladni::report {

/// The modes of a body: number, frequency, kind, nodal diameters where `diameters` (by mode number)
/// has them, and for modes in the certificate the estimated relative error of the frequency and
/// half the bound of the relative error of omega^2.
Json modes_json(const mbs_export::ModalBody& body, const mbs_export::Certificate& certificate,
                const std::map<int, int>& diameters);

/// The eigenvalue counts of the certificate: upper limit, expected and found number; null when none
/// were counted.
Json counts_json(const mbs_export::Certificate& certificate);

/// Size and error for each step of the selection; null when no tolerance chose the modes.
Json selection_json(const mbs_export::ModalBody& body);

}  // namespace chladni::report
