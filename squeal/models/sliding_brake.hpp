#pragma once

#include <variant>

#include "squeal/model_options.hpp"
#include "squeal/models/lumped_brake.hpp"
#include "squeal/models/sliding_masses.hpp"

namespace chladni::squeal {

/// Masses that rub, with x = (q w, q'), w^2 = K_11 / M_1. The first contact point appears as the
/// upper pad of a pair and the last one as the lower pad: `z` is the observed coordinate of both,
/// f_t the friction on the mass.
class SlidingBrake final : public LumpedBrake {
 public:
  using Model = std::variant<Oscillator, TwoMasses, TiltingBlock>;

  explicit SlidingBrake(const Model& model);

  Eigen::MatrixXd state_matrix(double speed) const override;
  std::unique_ptr<Brake> with(MapParameter parameter, double value) const override;
  std::vector<ParameterValue> parameters() const override;
  /// Points of the friction table.
  std::vector<BrakeNumber> further_numbers() const override;
  std::unique_ptr<AutonomousMotion> motion(double speed) const override;
  double rest_compression() const override;

  Eigen::Index size() const override { return 2 * masses_.M.size(); }
  Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const override;
  ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const override;
  Eigen::VectorXd start(double displacement) const override;
  double rest_height() const override { return 0.0; }

 private:
  Model model_;
  SlidingMasses masses_;
};

}  // namespace chladni::squeal
