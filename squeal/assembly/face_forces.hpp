#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Derivatives of the contact force at a point by its motion and its rates about the sliding
/// equilibrium.
struct FaceDerivatives {
  Eigen::MatrixXd by_motion;  ///< [rows x rows]
  Eigen::MatrixXd by_rate;    ///< [rows x rows]
};

/// Contact derivatives of a pad above (sigma = 1) or below (sigma = -1) the disc, by complex steps.
/// Rows are those of the disc, then (r, t, z) of the pad.
/// @param rows   6 on a middle surface, 8 with in-plane displacements
/// @param speed  rad/s, > 0
FaceDerivatives face_derivatives(const PadContact& pad, double sigma, int rows, double speed);

}  // namespace chladni::squeal
