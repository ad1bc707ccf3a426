#pragma once

#include <vector>

#include "mbs_export/measured/measured_modes.hpp"
#include "mbs_export/measured/modal_assurance.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

/// The report of `chladni mac`: measured mode shapes compared with a body's modes.
namespace chladni::report {

/// For each measured mode the most similar mode of the body: both frequencies, their difference,
/// the MAC, and the second largest MAC.
TextTable list_assurance(const mbs_export::MeasuredModes& measured,
                         const mbs_export::ModalAssurance& found);

/// The numbers of compared nodes and components, and the distances between paired nodes.
TextTable describe(const mbs_export::ModalAssurance& found);

/// JSON members `measured_Hz`, `body_modes`, `body_Hz`, `mac` (a row for each measured mode),
/// `n_components`, and `nodes` with `node`, `position`, `distance_m`.
std::vector<Json::Member> assurance_json(const mbs_export::ModalAssurance& found);

}  // namespace chladni::report
