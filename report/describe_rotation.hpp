#pragma once

#include "report/output.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::report {

/// Adds the method of the growth rates, the largest exponents at the least stable speed, and the
/// growth rate of a disc frozen at its worst angle. Adds nothing for files of earlier versions.
void add_rotation_method(TextTable& table, const squeal::RotationStability& stability);

}  // namespace chladni::report
