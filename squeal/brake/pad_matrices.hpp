#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "squeal/squeal_options.hpp"

/// Plates and calipers on their suspensions, without contact.
namespace chladni::squeal {

/// One degree of freedom of a plate.
struct PlateFreedom {
  /// 0, 1, 2: translation (radial, tangential, axial); 3, 4, 5: rotation about these.
  int direction;
  double inertia;  ///< kg or kg m^2
  Suspension suspension;
};

/// The degrees of freedom of a plate that have a suspension, by ascending direction.
/// @param shim  damping layer behind the plate
std::vector<PlateFreedom> freedoms(const PadBody& body, const std::optional<Shim>& shim = {});

/// Mass, damping and stiffness of M u'' + C u' + K u = f for plates and calipers.
struct PadMatrices {
  Eigen::MatrixXd M, C, K;
};

/// Number of coordinates of a pad pair: those of the upper plate, the lower plate and the caliper.
Eigen::Index n_coordinates(const PadPair& pad);

/// The matrices of all pads in their order; M is diagonal.
PadMatrices pad_matrices(const SquealOptions& options);

}  // namespace chladni::squeal
