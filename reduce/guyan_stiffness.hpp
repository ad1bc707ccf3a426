#pragma once

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// Static condensation to the masters.
struct GuyanStiffness {
  Eigen::MatrixXd K;  ///< K_G [n_m x n_m]
  Eigen::MatrixXd R;  ///< [n_m x r] independent motions of the masters with K_G R = 0
};

/// K_G = K_mm + K_ms Psi, symmetric to the last bit, and the motions that it does not resist: of
/// a free body its rigid ones. They are found by their energy in the whole model, u^T K u with u =
/// [u_m; Psi u_m], against that of its rows one by one, u^T diag(K) u, of which round-off is a
/// share near the machine's precision whatever the masters are. K_G has no stiffness along them.
/// @note   Collective.
/// @throws chladni::Error on all ranks when K is indefinite.
GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K);

}  // namespace chladni::reduce
