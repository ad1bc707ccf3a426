#pragma once

#include "linear/cholesky/cholesky_callbacks.hpp"
#include "linear/cholesky/cholesky_types.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"

namespace chladni::linear {

/// The factor of our own that solves for PETSc's `factor`, or null where another package does.
inline SupernodalFactor* supernodal_of(Mat factor)
{
  return is_ours(factor) ? dynamic_cast<SupernodalFactor*>(&factor_of(factor).active()) : nullptr;
}

}  // namespace chladni::linear
