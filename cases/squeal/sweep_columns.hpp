#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "squeal/results/results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::cases {

/// Whether a sweep can keep numbers of an analysis.
bool has_sweep_columns(std::string_view analysis);

/// What a sweep keeps of each variant: a few numbers of each analysis that the study asks for.
/// @throws chladni::Error when it asks for an analysis of which no number can be kept.
std::vector<squeal::SweepColumn> sweep_columns(const squeal::StudyOptions& study);

/// The numbers of one run in the order of the columns; absent where the run has none: a brake may
/// be stable, or an analysis have failed.
std::vector<std::optional<double>> sweep_row(const squeal::StudyOptions& study,
                                             const squeal::SquealResults& results);

}  // namespace chladni::cases
