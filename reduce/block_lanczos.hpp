#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::reduce {

struct BlockLanczosOptions {
  PetscInt n_pairs;           ///< wanted
  PetscInt block_size = 8;    ///< a block solve costs 5 to 8 times less per column than single ones
  PetscInt max_subspace = 0;  ///< basis vectors before a restart; 0 = 2 n_pairs + 16 blocks
  PetscInt max_steps = 1000;  ///< block solves
  double tolerance = 1e-9;    ///< residual of K^-1 M x = theta x relative to theta, in the M norm
};

/// Eigenpairs of lowest lambda of K x = lambda M x, ascending, X^T M X = I.
struct EigenPairs {
  std::vector<double> lambda;    ///< [k] with k >= n_pairs unless fewer exist
  std::vector<double> residual;  ///< [k] relative, as in `tolerance`
  petsc::Matrix X;               ///< [n x k] dense
  PetscInt n_solves;             ///< columns solved with the factor
};

/// Block Lanczos for K^-1 M with full reorthogonalisation in the M inner product and thick restart.
/// M may be singular: the Ritz vectors are purified by the step x <- K^-1 M x / theta, which the
/// recurrence holds already. Start vectors depend on the global row only, so that the result does
/// not depend on the number of ranks beyond round-off.
/// @param factor  Cholesky factor of K, for MatMatSolve.
/// @note   Collective.
/// @throws chladni::Error when not all pairs converge in `max_steps`.
/// Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994) 228; thick restart: Wu and
/// Simon, SIAM J. Matrix Anal. Appl. 22 (2000) 602; purification: Nour-Omid, Parlett, Ericsson and
/// Jensen, Math. Comp. 48 (1987) 663.
EigenPairs block_lanczos(Mat factor, Mat M, const BlockLanczosOptions& options);

}  // namespace chladni::reduce
