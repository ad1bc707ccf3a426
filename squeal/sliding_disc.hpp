#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/contact.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/pad_system.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The motion of an axisymmetric disc between pads in the inertial frame, x' = f(x) with
/// x = (diag(omega) a, p), pads with a mass at the end of a and p, all of the unit m kg^(1/2) / s.
/// f is smooth but where the axial force of a pad passes zero; there the integration stops and goes
/// on with the other branch of the contact law, so that it keeps its order. A pad that leaves and
/// returns within one step is not seen to do so.
class SlidingDisc {
 public:
  /// A contact point pair.
  struct Point {
    PadContact contact;
    PairShapes S;
    PadState<double> at_rest;  ///< of its upper pad
  };

  SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed);

  double speed() const { return speed_; }  ///< rad/s
  Eigen::Index size() const { return A_.rows(); }

  /// f(x) with the contact law as it is at x.
  Eigen::VectorXd rate(const Eigen::VectorXd& x);

  /// x after `time` (s), in `n_steps` steps of order 8.
  Eigen::VectorXd advance(const Eigen::VectorXd& x, double time, int n_steps);

  /// x after `time` and its derivatives by the initial x, in `n_steps` steps of order 8.
  struct Flow {
    Eigen::VectorXd end;
    Eigen::MatrixXd derivative;  ///< [size x size]
  };
  Flow flow(const Eigen::VectorXd& x, double time, int n_steps);

  /// The first pad pair at x.
  ContactResult<double> first_contact(const Eigen::VectorXd& x) const;

  /// Evaluations of the contact forces of all pads so far; one with derivatives counts as seven,
  /// since a derivative in each of six directions costs as much as the force.
  std::int64_t n_evaluations() const { return n_evaluations_; }

 private:
  /// Friction factor of each point, upper and lower one of each pair in turn: 1 in contact, -1
  /// where a bilateral pad pulls, 0 where a unilateral pad is off.
  using Branches = std::vector<double>;

  struct PointMotion {
    PairVector<double> g, g_dot;  ///< see PairShapes
  };

  /// When the force of a pad passes zero, s after the begin of a step.
  struct Change {
    std::size_t pad;
    double after;
  };

  PointMotion motion_at(const Point& point, const Eigen::VectorXd& x) const;
  Eigen::VectorXd axial_forces(const Eigen::VectorXd& x);
  Branches branches_at(const Eigen::VectorXd& x);
  Eigen::MatrixXd field(const Eigen::MatrixXd& Y, const Branches& branches);
  std::optional<Change> first_change(const Eigen::VectorXd& x, const Eigen::VectorXd& end,
                                     double step, const Branches& branches);
  Eigen::MatrixXd advance_over(Eigen::MatrixXd Y, double step, Branches& branches);
  Eigen::MatrixXd integrate(Eigen::MatrixXd Y, double time, int n_steps);

  double speed_;
  double pulled_;  ///< branch of a pad whose axial force is negative
  PadSystem pads_;
  Eigen::VectorXd by_omega_;
  Eigen::MatrixXd A_;  ///< of the disc and the plates without contact, 1/s
  std::vector<Point> points_;
  std::int64_t n_evaluations_ = 0;
};

}  // namespace chladni::squeal
