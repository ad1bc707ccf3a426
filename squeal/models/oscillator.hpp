#pragma once

#include "squeal/model_options.hpp"
#include "squeal/models/lumped_brake.hpp"

namespace chladni::squeal {

/// The oscillator with x = (x w, y w, x', y'), w^2 = k_x / m. The contact is reported as both pads
/// of a pair: `z` is y and f_t the friction on the mass.
class OscillatorBrake final : public LumpedBrake {
 public:
  explicit OscillatorBrake(const Oscillator& oscillator) : o_(oscillator) {}

  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override;
  /// Points of the friction table.
  std::vector<BrakeNumber> further_numbers() const override;
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override { return o_.preload / o_.contact_stiffness; }

  Eigen::Index size() const override { return 4; }
  Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const override;
  ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const override;
  Eigen::VectorXd start(double displacement) const override;
  double rest_height() const override { return 0.0; }

 private:
  Oscillator o_;
};

/// Friction coefficient at which the frequencies of the undamped oscillator coincide and flutter
/// begins, mu = ((k_x - k_y - k_c)^2 / 4 + k_xy^2) / (k_xy k_c).
double flutter_friction(const Oscillator& oscillator);

}  // namespace chladni::squeal
