#pragma once

#include "squeal/models/lumped_brake.hpp"
#include "squeal/models/rigid_disc.hpp"

namespace chladni::squeal {

/// The rigid disc with x = (w q, q'), w^2 = k_t / Theta. Drive::moment adds a fifth entry, the
/// deviation of the spin from the speed (rad/s), which is constant in the linearised equations.
/// These have no periodic motion to search for.
class RigidDiscBrake final : public LumpedBrake {
 public:
  explicit RigidDiscBrake(const RigidDiscStudy& study) : study_(study) {}

  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override;
  /// Points of the friction table.
  std::vector<BrakeNumber> further_numbers() const override;
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

  Eigen::Index size() const override { return study_.drive == Drive::moment ? 5 : 4; }
  Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const override;
  ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const override;
  Eigen::VectorXd start(double displacement) const override;
  double rest_height() const override { return 0.5 * study_.disc.thickness; }

 private:
  RigidDiscStudy study_;
};

}  // namespace chladni::squeal
