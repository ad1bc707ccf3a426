#pragma once

#include <vector>

#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/measured/modal_assurance.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

/// What `chladni mac` tells of measured shapes beside a body's modes.
namespace chladni::report {

/// For each measured mode the mode of the body that resembles it most: frequencies, their
/// difference, MAC, and the MAC of the next one.
TextTable list_assurance(const mbs_export::MeasuredModes& measured,
                         const mbs_export::ModalAssurance& found);

/// How many nodes and components were compared, and how far nodes are from their counterparts.
TextTable describe(const mbs_export::ModalAssurance& found);

/// Members `measured_Hz`, `body_modes`, `body_Hz`, `mac` (a row for each measured mode),
/// `n_components`, and `nodes`: `node`, `position`, `distance_m`.
std::vector<Json::Member> assurance_json(const mbs_export::ModalAssurance& found);

}  // namespace chladni::report
