#pragma once

#include <functional>

#include "squeal/brake/disc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/stability_table.hpp"
#include "squeal/stability/turning_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The search of `options.stability`; if absent, all motions over the speeds of the study.
StabilityCase stability_case(const StudyOptions& options);

/// Refuses a frequency band above the range of a disc's modes with inertia, where the modes do not
/// represent the disc.
/// @throws chladni::Error with the band and the range of the modes.
void require_band_of(const Disc& disc, const StabilityCase& search);

/// Computes the table of a disc that is not axisymmetric.
using TurningTableOf =
    std::function<StabilityTable(const FlexibleDisc& brake, const StabilityCase& search)>;

/// Table of all motions of the sliding brake with a frequency in the band at some value of the
/// parameter. They are followed by their shapes (see mode_samples.hpp) at 128 or more values, with
/// the intervals in which each is unstable (see mode_limits.hpp). Growth within rounding errors of
/// a neutral motion does not count. For a disc that is not axisymmetric the table is computed by
/// Hill's method; see turning_table.hpp.
/// @param by_hill  computes that table; an analysis among others passes the TurningTables of its
///         run
/// @throws chladni::Error for a band that the modes of the body do not reach.
StabilityTable unstable_modes(const Brake& brake, const StabilityCase& search,
                              const TurningTableOf& by_hill = turning_table);

}  // namespace chladni::squeal
