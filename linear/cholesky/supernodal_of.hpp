#pragma once

#include "linear/cholesky/cholesky_callbacks.hpp"
#include "linear/cholesky/cholesky_types.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"

namespace chladni::linear {

/// Our own factor behind PETSc's `factor`; null if another package solves.
inline SupernodalFactor* supernodal_of(Mat factor)
{
  return is_ours(factor) ? dynamic_cast<SupernodalFactor*>(&factor_of(factor).active()) : nullptr;
}

}  // namespace chladni::linear
