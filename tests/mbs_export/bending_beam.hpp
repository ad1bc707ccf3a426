#pragma once

#include <Eigen/Core>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::test {

/// Free Bernoulli-Euler beam on the x axis, L = EI = rho A = 1: two-node Hermite elements with
/// consistent mass, DOFs w and theta_y = -w' of each node, so K u = f has two rigid motions.
struct BendingBeam {
  Eigen::MatrixXd K, M;  ///< [2 (n + 1) x 2 (n + 1)]
};
BendingBeam bending_beam(int n_elements);

/// Its Craig-Bampton reduction to nodes A (x = 0), B (L/3), C (L), the sets "A", "B", "C", and
/// `n_modes` fixed-interface modes; masters w_A, theta_A, w_B, theta_B, w_C, theta_C.
ReducedSystem reduced_beam(int n_elements, int n_modes);

/// 300 elements and 100 modes, 106 x 106, made once: the regression case of the method.
const ReducedSystem& regression_beam();

}  // namespace chladni::mbs_export::test
