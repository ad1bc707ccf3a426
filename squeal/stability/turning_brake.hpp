#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/point_shapes.hpp"

namespace chladni::squeal {

/// Coordinates z of the inertial frame for a disc that need not be axisymmetric: q = R exp(phi D) z
/// with D = [0 d; -d 0] for each pair of coordinates and 0 for the others. Any choice of pairs is
/// valid; it only affects how much of the equations depends on the angle phi.
struct TurningCoordinates {
  Eigen::MatrixXd R;  ///< [n_modes x n_modes] orthogonal
  /// [n_modes] nodal diameters; the two of a pair are adjacent, 0 for a single coordinate.
  std::vector<int> d;
};

/// Pairs each mode with the nearest frequency of the same dominant harmonic, if there is one within
/// 10 % whose shape is rotated relative to its own.
TurningCoordinates nearest_pairs(const Disc& disc);

/// The highest harmonic of the mode shapes along the rings and of the pairs.
int highest_harmonic(const Disc& disc, const TurningCoordinates& coordinates);

/// Small motions of a sliding disc and its pads, x' = A(phi) x with phi = speed t and x = (diag(w)
/// z, p), where p are the rates of the disc's material points in the coordinates z. The disc need
/// not be axisymmetric. A has the period 2 pi; for an axisymmetric disc it is constant and equal to
/// `state_matrix`.
class TurningBrake {
 public:
  TurningBrake(const Disc& disc, const TurningCoordinates& coordinates,
               const SquealOptions& options, double speed);

  /// A when the disc has rotated by `phi` (rad).
  /// @return [2 n x 2 n] 1/s, n = n_modes + modes of the pads
  Eigen::MatrixXd at(double phi);

 private:
  Eigen::MatrixXd turned(const Eigen::MatrixXd& M, double phi) const;

  double speed_;
  std::vector<int> d_;
  Eigen::MatrixXd R_;
  PadSystem pads_;
  PointShapes shapes_;
  StackedContact contact_;  ///< shapes at the last angle
  /// Stiffness and damping of the disc without pads, in the coordinates at phi = 0.
  Eigen::MatrixXd K_, C_;
  Eigen::VectorXd w_;  ///< [n] rad/s, the same for both coordinates of a pair
};

}  // namespace chladni::squeal
