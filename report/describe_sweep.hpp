#pragma once

#include "report/output.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::report {

/// What varies and what is found, each from its least to its largest number, and the variants that
/// failed.
TextTable describe(const squeal::SweepTable& sweep);

}  // namespace chladni::report
