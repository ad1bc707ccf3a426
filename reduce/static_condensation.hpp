#pragma once

#include "linear/cholesky/factorization.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// The result of static condensation to the masters.
struct GuyanStiffness {
  Eigen::MatrixXd K;  ///< K_G [n_m x n_m]
  Eigen::MatrixXd R;  ///< [n_m x r] independent motions of the masters with K_G R = 0
};

/// K_G = K_mm + K_ms Psi, exactly symmetric, and its zero-energy motions R, which are the rigid
/// ones of a free body. R is found by comparing the energy in the whole model, u^T K u with u =
/// [u_m; Psi u_m], with u^T diag(K) u, of which round-off is a share near machine precision
/// whichever DOFs are masters. K_G is returned with K_G R = 0.
/// @note   Collective.
/// @throws chladni::Error on all ranks when K is indefinite, or a motion of R has no mass either.
GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K, const Blocks& M);

/// Psi = -K_ss^-1 K_sm: displacements of the slaves for unit displacements of the masters. The
/// right-hand sides are sparse on one rank, and dense in blocks of columns on several.
/// @param K  blocks of the stiffness; K.ms = K.sm^T
/// @return [n_s x n_m] dense, rows as K_ss
/// @note   Collective on the communicator of `K.ms`.
petsc::Matrix constraint_modes(const linear::Factorization& K_ss, const Blocks& K);

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
