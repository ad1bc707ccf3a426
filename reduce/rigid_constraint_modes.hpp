#pragma once

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// Motions of a body that are known from its geometry, with the partition and blocks of K.
struct KnownMotions {
  Mat R;                     ///< [n x k] dense, in all DOFs
  const DofPartition& dofs;  ///< of K
  const Blocks& K;
};

/// Corrects constraint modes so that they carry rigid motions of the masters to the slaves exactly:
/// Psi R_m = R_s. Used are those combinations of the known motions that K does not resist, K R = 0
/// to round-off in each row. Without the correction the condition of K_ss amplifies round-off: a
/// thin plate on a single node loses eight digits and more.
/// @param Psi  [n_s x n_m] dense
/// @note   Collective.
petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions);

}  // namespace chladni::reduce
