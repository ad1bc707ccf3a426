#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mbs_export/modal_body.hpp"

namespace chladni::squeal {

/// Description of a mode from its motion over the whole disc.
struct ModeFigure {
  /// Number of nodal circles: sign changes of the axial motion along the radius. Absent when the
  /// body has no picture, and for modes that are mainly in-plane.
  std::optional<int> circles = {};
  /// In-plane fraction of the kinetic energy; absent when the body has no mass integrals.
  std::optional<double> in_plane = {};
};

/// Descriptions of all modes of a body.
/// @param diameters  [n_modes] nodal diameters
std::vector<ModeFigure> mode_figures(const mbs_export::ModalBody& body,
                                     const std::vector<int>& diameters);

}  // namespace chladni::squeal
