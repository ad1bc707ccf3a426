#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Elastic modes of a reduced system under the supports of a scene.
struct HeldModeShapes {
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending, positive
  Eigen::MatrixXd X;      ///< [n_FE x k] in the reduced coordinates, X^T M_r X = I
  int n_rigid;            ///< rigid-body motions that the support leaves free
  int n_free_rigid;       ///< rigid-body motions without the support
};

/// @param fixed  as BodyOptions::fixed.
/// @throws chladni::Error as orthogonalize, held_dofs and shift_modes.
HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                                const linear::LowestModes& wanted = {});

/// Of the rigid-body motions without any support, as FreeModes::rigid_residual; to a few per cent.
/// @throws chladni::Error as rigid_modes.
double rigid_residual(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export
