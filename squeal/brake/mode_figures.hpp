#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::squeal {

/// How the disc moves in a mode, away from its rings too.
struct ModeFigure {
  /// Nodal circles of the motion along the axis: its changes of sign along the radius. Absent where
  /// the body has no picture, and for modes that move in the plane in the main.
  std::optional<int> circles = {};
  /// Share of the kinetic energy that is motion in the plane; absent where the body has no mass
  /// integrals.
  std::optional<double> in_plane = {};
};

/// @param diameters  [n_modes] of each mode of the body
std::vector<ModeFigure> mode_figures(const mbs_export::ModalBody& body,
                                     const std::vector<int>& diameters);

}  // namespace chladni::squeal
