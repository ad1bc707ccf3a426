#pragma once

#include <Eigen/Core>

namespace chladni::plate {

/// K_e and M_e in the DOFs (u_x, u_y, u_z, theta_x, theta_y, theta_z) of each node in lattice
/// order.
struct ElementMatrices {
  Eigen::MatrixXd K, M;
};

}  // namespace chladni::plate
