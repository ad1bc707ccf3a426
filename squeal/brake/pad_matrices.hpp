#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "squeal/squeal_options.hpp"

/// Plates and calipers on their suspensions, without contact.
namespace chladni::squeal {

/// One degree of freedom of a plate.
struct PlateFreedom {
  int direction;  ///< 0, 1, 2: translation (radial, tangential, axial); 3, 4, 5: rotation about it
  double inertia;
  Suspension suspension;
};

/// Those that have a suspension, in the order of their directions.
/// @param shim  behind the plate
std::vector<PlateFreedom> freedoms(const PadBody& body, const std::optional<Shim>& shim = {});

/// M u'' + C u' + K u = f of plates and calipers.
struct PadMatrices {
  Eigen::MatrixXd M, C, K;
};

/// Coordinates of one pad pair: those of the upper plate, of the lower plate, and the caliper.
Eigen::Index n_coordinates(const PadPair& pad);

/// Of all pads, in their order; M is diagonal.
PadMatrices pad_matrices(const SquealOptions& options);

}  // namespace chladni::squeal
