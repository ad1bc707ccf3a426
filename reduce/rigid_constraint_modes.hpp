#pragma once

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// The motions of a body that its geometry gives, and the blocks in which the reduction sees it.
struct KnownMotions {
  Mat R;                     ///< [n x k] dense, of all DOFs
  const DofPartition& dofs;  ///< of K
  const Blocks& K;
};

/// Constraint modes that carry a rigid motion of the masters to the slaves exactly: Psi R_m = R_s
/// for those combinations of the known motions that K does not resist, K R = 0 to round-off row by
/// row. The solution with K_ss leaves of round-off what its condition makes of it: a thin plate on
/// a single node loses eight digits and more.
/// @note   Collective.
petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions);

}  // namespace chladni::reduce
