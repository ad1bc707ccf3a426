#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/point_shapes.hpp"

namespace chladni::brake_fmu {

/// A disc and the pads that it turns between.
struct BrakeModel {
  std::string token;  ///< that modelDescription.xml has too
  squeal::Disc disc;
  squeal::PadSystem pads;
  /// As the scene has it, that of all points.
  double friction;
  double speed;  ///< with which a simulation begins, rad/s

  Eigen::Index n_modes() const { return disc.n_modes() + pads.n_modes(); }
};

/// N of each pad pair of the scene.
std::vector<double> preloads_of(const squeal::PadSystem& pads);

/// What drives a brake from outside.
struct Drive {
  double speed;                  ///< Omega of the disc, rad/s
  double friction;               ///< coefficient of sliding, far above the decay speed of the law
  std::vector<double> preloads;  ///< [n_pads] N

  bool operator==(const Drive&) const = default;
};

/// The disc and its pads in the frame that turns with the disc, at any speed:
/// q'' + (C + 2 Omega G) q' + diag(omega^2) q = sum over points of S(angle) F(S^T q, S^T q').
/// Motions are counted from the sliding equilibrium at the present speed, friction and preloads;
/// that the speed changes is felt through it alone, not as a force of inertia.
class DrivenDisc {
 public:
  explicit DrivenDisc(const BrakeModel& model);

  /// @throws chladni::Error for a speed that is not positive where friction is not regularised, a
  ///         friction below zero and a preload that is not positive.
  void set_drive(const Drive& drive);

  /// q'' of the disc's modes, then of those of the pads.
  /// @param angle  by which the disc has turned, rad
  Eigen::VectorXd acceleration(double angle, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  /// The contacts of the last `acceleration`, one for each pad pair.
  std::vector<squeal::ContactResult<double>> contacts() const;
  /// Of friction about the axis at the last `acceleration`, on the disc, N m.
  double torque() const;

  /// The largest rates of the brake at rest: of its oscillations, with the pads as springs, and of
  /// the decay by the pads' dampers, rad/s and 1/s.
  struct Rates {
    double omega, decay;
  };
  Rates fastest();

  const Eigen::VectorXd& omega() const { return omega_; }

 private:
  void rebuild();

  const BrakeModel& model_;
  squeal::PadSystem pads_;  ///< with the contacts of the present drive
  squeal::PointShapes shapes_;
  squeal::ContactSeries series_;
  Eigen::VectorXd omega_;
  Eigen::MatrixXd C_;  ///< with the Coriolis terms at the present speed
  Drive drive_;
  std::vector<squeal::BrakePoint> points_;
  std::vector<squeal::PointMotion> motions_;
  std::vector<squeal::ContactResult<double>> contacts_;  ///< of each point
};

}  // namespace chladni::brake_fmu
