#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/constrained_modes.hpp"
#include "mbs_export/held_dofs.hpp"
#include "mbs_export/mode_shift.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {

/// A reduced system under its supports: free modes, shifted modes, modes of the held body.
struct HeldBody {
  FreeModes free;
  HeldDofs held;
  ModeShift shift;
  ConstrainedModes constrained;
  Eigen::MatrixXd T;  ///< Q_e Q_c X, [n_FE x n] modes in the coordinates of the reduced system
  Eigen::MatrixXd U;  ///< [6 n_nodes x n] motion of the attachment nodes in the modes T
};

/// Computes the modes of a reduced system under its supports.
/// @param fixed  as BodyOptions::fixed
/// @throws chladni::Error as `orthogonalize`, `held_dofs` and `shift_modes`.
HeldBody held_body(const ReducedSystem& reduced, const std::vector<std::string>& fixed);

}  // namespace chladni::mbs_export
