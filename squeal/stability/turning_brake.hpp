#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/point_shapes.hpp"

namespace chladni::squeal {

/// Coordinates in which the motion of a disc is seen from the inertial frame: q = R exp(phi D) z,
/// where D = [0 d; -d 0] for each pair of coordinates and 0 for the others. Any choice of pairs is
/// allowed: it decides only how much of the equations still depends on the angle phi.
struct TurningCoordinates {
  Eigen::MatrixXd R;   ///< [n_modes x n_modes] orthogonal
  std::vector<int> d;  ///< [n_modes] nodal diameters; pairs are neighbours, 0: no partner
};

/// Pairs each mode with the nearest frequency of the same dominant harmonic, if there is one within
/// 10 % whose shape is turned against its own.
TurningCoordinates nearest_pairs(const Disc& disc);

/// The highest harmonics of the shapes along the rings and of the pairs.
int highest_harmonic(const Disc& disc, const TurningCoordinates& coordinates);

/// Small motions of a sliding disc of any kind, and of its pads, x' = A(phi) x with phi = speed t,
/// x = (diag(w) z, p) and p the rates of the disc's points in the coordinates of z. A has the
/// period 2 pi; it is constant when the disc is axisymmetric, where it is `state_matrix`.
class TurningBrake {
 public:
  TurningBrake(const Disc& disc, const TurningCoordinates& coordinates,
               const SquealOptions& options, double speed);

  /// [2 n x 2 n] 1/s, n = n_modes + modes of the pads, when the disc has turned by `phi` (rad).
  Eigen::MatrixXd at(double phi);

 private:
  Eigen::MatrixXd turned(const Eigen::MatrixXd& M, double phi) const;

  double speed_;
  std::vector<int> d_;
  Eigen::MatrixXd R_;
  PadSystem pads_;
  PointShapes shapes_;
  StackedContact contact_;  ///< its shapes are those of the last angle
  Eigen::MatrixXd K_, C_;   ///< of the disc without pads, in the coordinates at phi = 0
  Eigen::VectorXd w_;       ///< [n] rad/s, the same for both of a pair
};

}  // namespace chladni::squeal
