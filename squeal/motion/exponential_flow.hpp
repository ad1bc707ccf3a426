#pragma once

#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Time steps of an axisymmetric disc in the inertial frame, x = (diag(omega) a, p), by Strang
/// splitting. The linearised sliding disc is integrated exactly, x(t + h) = exp(h A) x(t); the
/// nonlinear remainder of the pad forces is a kick of p by the explicit midpoint rule between two
/// halves of this flow. Growth and decay of small motions are exact for any step; the error of
/// large motions is of second order.
class ExponentialFlow {
 public:
  /// @param step  step size h, s
  ExponentialFlow(const InertialDisc& disc, const SquealOptions& options, double speed,
                  double step);

  /// Size of x, including the modes of the pads.
  Eigen::Index size() const { return half_.rows(); }

  /// Advances by half a step of the flow, for the first and the last step.
  void advance_half(Eigen::VectorXd& x) const { x = (half_ * x).eval(); }
  /// Advances by a whole step of the flow.
  void advance(Eigen::VectorXd& x);

  /// Applies the kick of a whole step.
  /// @return contact states at its midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& kick(Eigen::VectorXd& x);

 private:
  /// A contact point with its shapes divided by the frequencies.
  struct Point {
    BrakePoint at;
    PairShapes S_by_omega;
  };

  /// Adds `factor` times the nonlinear remainder of the forces at the rates `p` to `to`.
  void add_remainders(const Eigen::VectorXd& p, double factor, Eigen::Ref<Eigen::VectorXd> to);

  double speed_;
  double step_;
  Eigen::MatrixXd half_, whole_;
  PadSystem pads_;
  std::vector<Point> points_;
  std::vector<PairVector<double>> position_;
  ContactSeries series_;
  StackedContact linear_;  ///< linear part of the forces
  std::vector<PointMotion> motions_;
  Eigen::VectorXd linear_force_;
  std::vector<ContactResult<double>> contacts_;  ///< of each point at the last evaluation
  std::vector<ContactResult<double>> of_pads_;   ///< of each pad pair at the last kick
  Eigen::VectorXd next_, p_mid_;
};

}  // namespace chladni::squeal
