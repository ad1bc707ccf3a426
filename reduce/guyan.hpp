#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// K_G = K_mm + K_ms Psi, symmetric to the last bit, without the round-off of rigid-body motions.
/// @note   Collective, as all of this header.
SmallMatrix guyan_stiffness(Mat Psi, const Blocks& K);

/// M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi), symmetric to the last bit.
SmallMatrix guyan_mass(Mat Psi, const Blocks& M);

/// P = Phi^T (M_ss Psi + M_sm), [columns of Phi x n_m].
SmallMatrix inertial_coupling(Mat Phi, Mat Psi, const Blocks& M);

/// K_r = diag(K_G, diag(omega^2)), M_r = [M_G, P^T; P, I].
/// @param P  rows of all modes of `omega`, or more
ReducedModel join(const SmallMatrix& K_G, const SmallMatrix& M_G, const SmallMatrix& P,
                  std::vector<double> omega);

}  // namespace chladni::reduce
