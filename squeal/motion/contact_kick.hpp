#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/point_shapes.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/motion/speed_program.hpp"

namespace chladni::squeal {

/// Contact forces of all pads on a rotating disc and on plates with a mass, and their kick in the
/// Strang splitting. Coordinates are the modes of the disc, then those of the pads.
class ContactKick {
 public:
  ContactKick(const Disc& disc, const SquealOptions& options, double speed);

  /// Integrates v' = Q(q, v, t) with q and t constant over `step` (s) by the explicit midpoint
  /// rule. Q includes the Coriolis terms of the disc.
  /// @return contact states at the midpoint, one for each pad pair; valid until the next call
  const std::vector<ContactResult<double>>& apply(ModalState& x, const Turn& turn, double step);

  /// The kick at time t (s) of a disc at constant speed.
  const std::vector<ContactResult<double>>& apply(ModalState& x, double t, double step)
  {
    return apply(x, Turn{speed_ * t, speed_}, step);
  }

  const PadSystem& pads() const { return pads_; }

  /// Linearised contact stiffness at the angle of the last kick, [n x n] 1/s^2.
  Eigen::MatrixXd contact_stiffness() const;

 private:
  /// Q at the rates `v` with the present shapes.
  const Eigen::VectorXd& force(const Eigen::VectorXd& v);

  /// Changes the preload. The motion is measured from the sliding equilibrium with this preload.
  /// @param preload  factor on the preload of all pads
  void press(double preload);

  double speed_;          ///< speed at the last kick, rad/s
  double first_speed_;    ///< speed of the sliding equilibrium, rad/s
  double preload_ = 1.0;  ///< preload factor at the last kick
  Eigen::MatrixXd G_;     ///< Coriolis matrix of the disc; see Disc
  PointShapes shapes_;
  PadSystem pads_;
  std::vector<BrakePoint> points_;  ///< present shapes; contact at rest at the first speed
  std::vector<PairVector<double>> position_;  ///< present motion of each point
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<ContactResult<double>> contacts_;  ///< of each point at the last evaluation
  std::vector<ContactResult<double>> of_pads_;   ///< of each pad pair at the last kick
  Eigen::VectorXd Q_;
  Eigen::VectorXd v_mid_;
};

}  // namespace chladni::squeal
