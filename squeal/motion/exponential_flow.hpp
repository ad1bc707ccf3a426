#pragma once

#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Steps of an axisymmetric disc in the inertial frame, x = (diag(omega) a, p): the sliding disc
/// with its linearised pads flows exactly, x(t + h) = exp(h A) x(t); what the pads do beyond that
/// is a kick of p by the explicit midpoint rule between two halves of the flow (Strang). Growth and
/// decay of small motions are exact at any step; the error of large ones is of second order.
class ExponentialFlow {
 public:
  /// @param step  h, s
  ExponentialFlow(const InertialDisc& disc, const SquealOptions& options, double speed,
                  double step);

  Eigen::Index size() const { return half_.rows(); }  ///< of x, with the modes of the pads

  /// Half a flow, for the first step and the last.
  void advance_half(Eigen::VectorXd& x) const { x = (half_ * x).eval(); }
  void advance(Eigen::VectorXd& x);

  /// The kick of a whole step.
  /// @return the contacts at its midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& kick(Eigen::VectorXd& x);

 private:
  struct Point {
    BrakePoint at;
    PairShapes S_by_omega;
  };

  /// Adds `factor` times the forces at the rates `p`, without their linear part, to `to`.
  void add_remainders(const Eigen::VectorXd& p, double factor, Eigen::Ref<Eigen::VectorXd> to);

  double speed_;
  double step_;
  Eigen::MatrixXd half_, whole_;
  PadSystem pads_;
  std::vector<Point> points_;
  std::vector<PairVector<double>> position_;
  ContactSeries series_;
  StackedContact linear_;  ///< the linear part of the forces
  std::vector<PointMotion> motions_;
  Eigen::VectorXd linear_force_;
  std::vector<ContactResult<double>> contacts_;  ///< of each point at the last remainder
  std::vector<ContactResult<double>> of_pads_;   ///< of each pad at the last kick
  Eigen::VectorXd next_, p_mid_;
};

}  // namespace chladni::squeal
