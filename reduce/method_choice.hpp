#pragma once

#include "reduce/reduction.hpp"

namespace chladni::reduce {

/// The method that is asked for. For `automatic`, the one of Craig-Bampton and mixed interface
/// whose eigen-solve is predicted to need fewer operations, with the numbers that decided.
/// @note   Collective.
/// @throws chladni::Error when `automatic` has no tolerance.
MethodChoice method_choice(const FactoredBody& body, const ReductionOptions& options,
                           const Support& support);

}  // namespace chladni::reduce
