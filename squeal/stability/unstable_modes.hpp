#pragma once

#include <functional>

#include "squeal/brake/disc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/stability_table.hpp"
#include "squeal/stability/turning_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// What `options.stability` asks for: without it all motions over the speeds of the study.
StabilityCase stability_case(const StudyOptions& options);

/// Refuses a band beyond the modes of a disc with inertia: what is above them has other frequencies
/// than the disc, or none.
/// @throws chladni::Error with the band and the range of the modes.
void require_band_of(const Disc& disc, const StabilityCase& search);

using TurningTableOf =
    std::function<StabilityTable(const FlexibleDisc& brake, const StabilityCase& search)>;

/// All motions of the sliding brake that have a frequency of the band at some value of the
/// parameter, followed by their shapes (see mode_samples.hpp), and the intervals in which each is
/// unstable (see mode_limits.hpp), on 128 values or more. Growth that rounding can make of a
/// neutral motion is none. Of a disc that is not axisymmetric it is the table of Hill's method; see
/// turning_table.hpp.
/// @param by_hill  makes that table; an analysis among others passes the TurningTables of its run
/// @throws chladni::Error for a band that the modes of the body do not reach.
StabilityTable unstable_modes(const Brake& brake, const StabilityCase& search,
                              const TurningTableOf& by_hill = turning_table);

}  // namespace chladni::squeal
