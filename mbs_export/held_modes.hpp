#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// All elastic modes of a reduced system under the supports of a scene.
struct HeldModeShapes {
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending, positive
  Eigen::MatrixXd X;      ///< [n_FE x k] in the reduced coordinates, X^T M_r X = I
  int n_rigid;            ///< rigid-body motions that the support leaves free
  int n_free_rigid;       ///< rigid-body motions without the support
  double rigid_residual;  ///< of these, as FreeModes::rigid_residual
};

/// @param fixed  as BodyOptions::fixed.
/// @throws chladni::Error as orthogonalize, held_dofs and shift_modes.
HeldModeShapes held_mode_shapes(const ReducedSystem& reduced,
                                const std::vector<std::string>& fixed);

}  // namespace chladni::mbs_export
