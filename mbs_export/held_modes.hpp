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
  int n_rigid;            ///< number of rigid-body motions that the support leaves
  int n_free_rigid;       ///< number of rigid-body motions without a support
};

/// The elastic modes of a reduced system under a support.
/// @param fixed   as BodyOptions::fixed
/// @param wanted  range of the modes; all by default
/// @throws chladni::Error as `orthogonalize`, `held_dofs` and `shift_modes`.
HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                                const linear::LowestModes& wanted = {});

/// FreeModes::rigid_residual of the body without a support, to a few per cent.
/// @throws chladni::Error as `rigid_modes`.
double rigid_residual(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export
