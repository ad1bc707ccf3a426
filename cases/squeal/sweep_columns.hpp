#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "squeal/results/results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::cases {

/// True if an analysis yields numbers that a sweep can keep.
bool has_sweep_columns(std::string_view analysis);

/// The numbers that a sweep keeps for each variant: a few of each analysis of the study.
/// @throws chladni::Error when an analysis yields no number to keep.
std::vector<squeal::SweepColumn> sweep_columns(const squeal::StudyOptions& study);

/// The numbers of one run in the order of the columns. A number is absent if a brake is stable or
/// an analysis has failed.
std::vector<std::optional<double>> sweep_row(const squeal::StudyOptions& study,
                                             const squeal::SquealResults& results);

}  // namespace chladni::cases
