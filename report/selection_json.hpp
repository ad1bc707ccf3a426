#pragma once

#include <vector>

#include "mbs_export/modal_body.hpp"
#include "report/json.hpp"

namespace chladni::report {

/// JSON members `condition_Q_dd`, `interface_modes_dropped`, `condition_directions` if known and,
/// when a tolerance chose the modes, `selection` with `tolerance`, `error_of_reduction`,
/// `up_to_Hz`, `loads` and, for `modes_only` and `with_interface_modes`, the steps {added, modes,
/// interface_modes, error}.
std::vector<Json::Member> preparation_json(const mbs_export::ModalBody& body);

}  // namespace chladni::report
