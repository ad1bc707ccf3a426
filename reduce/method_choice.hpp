#pragma once

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// The method that was asked for; of `automatic` the one that is predicted to cost least, by the
/// operations of its eigen-solve, with the numbers that decided.
/// @note   Collective.
/// @throws chladni::Error when `automatic` has no tolerance.
MethodChoice method_choice(const FactoredBody& body, const ReductionOptions& options,
                           const Support& support);

}  // namespace chladni::reduce
