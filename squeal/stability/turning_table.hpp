#pragma once

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_table.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The table of all motions of a disc that need not be axisymmetric, by Hill's method (hill.hpp):
/// characteristic exponents followed over the parameter (exponent_branches.hpp), on 32 values or
/// more. It has neither families of modes nor shares nor works, which need one shape for each
/// motion. Where the growth of a motion has an extremum near zero between the values, it is looked
/// for there.
/// @throws chladni::Error where Hill's method does.
StabilityTable turning_table(const FlexibleDisc& brake, const StabilityCase& search);

/// What a table says of the range as a whole: the least stable motions at its ends, and where any
/// of its motions grows.
StabilityProfile profile_of(const StabilityTable& table);

}  // namespace chladni::squeal
