#pragma once

#include "report/output.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::report {

/// Rows that tell how the growth rates were found, the worst exponents where the disc is least
/// stable, and what the disc would seem to do if it stood at some angle. None for files of earlier
/// versions.
void add_rotation_method(TextTable& table, const squeal::RotationStability& stability);

}  // namespace chladni::report
