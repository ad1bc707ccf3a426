#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// K_G = K_mm + K_ms Psi, symmetric to the last bit, and the motions that it does not resist: of
/// a free body its rigid ones. They are found by their energy in the whole model, u^T K u with u =
/// [u_m; Psi u_m], against that of its rows one by one, u^T diag(K) u, of which round-off is a
/// share near the machine's precision whatever the masters are. K_G has no stiffness along them.
/// @note   Collective, as all of this header.
/// @throws chladni::Error on all ranks when K is indefinite.
GuyanStiffness guyan_stiffness(Mat Psi, const Blocks& K);

/// M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi), symmetric to the last bit.
Eigen::MatrixXd guyan_mass(Mat Psi, const Blocks& M);

/// P = Phi^T (M_ss Psi + M_sm), [columns of Phi x n_m].
Eigen::MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M);

/// K_r = diag(K_G, diag(omega^2)), M_r = [M_G, P^T; P, I].
/// @param P  rows of all modes of `omega`, or more
ReducedModel join(const GuyanStiffness& K_G, const Eigen::MatrixXd& M_G, const Eigen::MatrixXd& P,
                  std::vector<double> omega);

}  // namespace chladni::reduce
