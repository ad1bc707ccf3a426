#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// Derivatives about the sliding equilibrium of the force at a point of contact by the motion there
/// and by its rates.
struct FaceDerivatives {
  Eigen::MatrixXd by_motion;  ///< [rows x rows]
  Eigen::MatrixXd by_rate;    ///< [rows x rows]
};

/// The contact of one pad above (sigma = 1) or below the disc, by complex steps; rows are those of
/// the disc, then (r, t, z) of the pad.
/// @param rows   6 on a middle surface, 8 with displacements in the plane
/// @param speed  rad/s, > 0
FaceDerivatives face_derivatives(const PadContact& pad, double sigma, int rows, double speed);

}  // namespace chladni::squeal
