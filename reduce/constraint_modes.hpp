#pragma once

#include "linear/cholesky/factorization.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// Psi = -K_ss^-1 K_sm: displacements of the slaves for unit displacements of the masters. The
/// right-hand sides are sparse on one rank, and dense in blocks of columns on several.
/// @param K  blocks of the stiffness; K.ms = K.sm^T
/// @return [n_s x n_m] dense, rows as K_ss
/// @note   Collective on the communicator of `K.ms`.
petsc::Matrix constraint_modes(const linear::Factorization& K_ss, const Blocks& K);

}  // namespace chladni::reduce
