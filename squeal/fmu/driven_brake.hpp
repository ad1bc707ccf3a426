#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::brake_fmu {

/// A disc with its pads, as a brake FMU simulates it.
struct BrakeModel {
  std::string token;  ///< export token, the same as in modelDescription.xml
  squeal::Disc disc;
  squeal::PadSystem pads;
  /// Kinetic friction coefficient of the scene, one for all points.
  double friction;
  double speed;  ///< initial rotation speed, rad/s

  Eigen::Index n_modes() const { return disc.n_modes() + pads.n_modes(); }
};

/// Preload of each pad pair, summed over its points.
/// @return [n_pads] N
std::vector<double> preloads_of(const squeal::PadSystem& pads);

/// Inputs of the brake that may change during a simulation.
struct Drive {
  double speed;     ///< rotation speed Omega of the disc, rad/s
  double friction;  ///< kinetic friction coefficient (the law's limit far above its decay speed)
  std::vector<double> preloads;  ///< [n_pads] N

  bool operator==(const Drive&) const = default;
};

/// Equations of motion of the disc and its pads in the frame that rotates with the disc:
/// q'' + (C + 2 Omega G) q' + diag(omega^2) q = sum over points of S(angle) F(S^T q, S^T q').
/// The coordinates q are measured from the sliding equilibrium at the present speed, friction and
/// preloads. A change of the speed acts through these terms only; its inertia force (Euler force)
/// is neglected.
class DrivenDisc {
 public:
  explicit DrivenDisc(const BrakeModel& model);

  /// Sets speed, friction and preloads.
  /// @throws chladni::Error for a speed that is not positive when friction is not regularised, for
  ///         a negative friction coefficient, and for a preload that is not positive.
  void set_drive(const Drive& drive);

  /// q'' of the disc's modes, then of the pads' modes.
  /// @param angle  rotation of the disc, rad
  /// @param v      q'
  Eigen::VectorXd acceleration(double angle, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  /// Contact states at the last `acceleration`, one for each pad pair.
  std::vector<squeal::ContactResult<double>> contacts() const;
  /// Moment of the friction forces on the disc about the axis at the last `acceleration`, N m.
  double torque() const;

  /// Largest rates of the linearised brake: the angular frequency of the fastest oscillation, with
  /// the pads as springs, rad/s, and the decay rate of the pads' dampers, 1/s.
  struct Rates {
    double omega, decay;
  };
  Rates fastest();

  const Eigen::VectorXd& omega() const { return omega_; }

 private:
  void rebuild();

  const BrakeModel& model_;
  squeal::PadSystem pads_;  ///< with the contact data of the present drive
  squeal::PointShapes shapes_;
  squeal::ContactSeries series_;
  Eigen::VectorXd omega_;
  Eigen::MatrixXd C_;  ///< with the Coriolis terms of the present speed
  Drive drive_;
  std::vector<squeal::BrakePoint> points_;
  std::vector<squeal::PointMotion> motions_;
  std::vector<squeal::ContactResult<double>> contacts_;  ///< one for each point
};

/// Name of the brake's file among the resources of its FMU.
inline constexpr auto brake_file = "brake.chladni-fmu";

/// The brake as bytes, with numbers in the byte order of this machine. It contains all that the
/// motion depends on, but not the figures of the modes.
std::string packed(const BrakeModel& model);

/// The brake that `packed` wrote.
/// @throws chladni::Error when the bytes are not a brake, are incomplete, or hold parts that do not
///         fit together.
BrakeModel unpacked_brake(std::string_view bytes);

}  // namespace chladni::brake_fmu
