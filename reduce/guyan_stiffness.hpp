#pragma once

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
/// @throws chladni::Error on all ranks when K is indefinite.
GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K);

}  // namespace chladni::reduce
