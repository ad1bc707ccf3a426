#pragma once

#include <cstdint>
#include <memory>

#include "brake_fmu/driven_disc.hpp"
#include "fmu/simulation.hpp"

namespace chladni::brake_fmu {

/// What an FMU tells of a pad, in this order; forces act on the disc.
enum class PadOutput {
  normal_force,
  axial_force,
  radial_force,
  tangential_force,
  height,
  velocity
};
inline constexpr int n_pad_outputs = 6;

/// Value references of the variables of a brake.
class BrakeReferences {
 public:
  BrakeReferences(Eigen::Index n_modes, std::size_t n_pads)
      : n_modes_(static_cast<std::uint32_t>(n_modes)), n_pads_(static_cast<std::uint32_t>(n_pads))
  {}
  static constexpr std::uint32_t time = 0, steps_per_period = 1, speed = 2, friction = 3;
  std::uint32_t preloads() const { return 4; }
  std::uint32_t torque() const { return preloads() + n_pads_; }
  /// Of each pad pair the outputs of the upper pad, then of the lower one.
  std::uint32_t pads() const { return torque() + 1; }
  std::uint32_t angle() const { return pads() + 2 * n_pad_outputs * n_pads_; }
  std::uint32_t q() const { return angle() + 1; }
  std::uint32_t q_dot() const { return q() + n_modes_; }
  std::uint32_t der_angle() const { return q_dot() + n_modes_; }
  std::uint32_t der_q() const { return der_angle() + 1; }
  std::uint32_t der_q_dot() const { return der_q() + n_modes_; }
  std::uint32_t end() const { return der_q_dot() + n_modes_; }

 private:
  std::uint32_t n_modes_, n_pads_;
};

/// Steps of the method of order 8 in a period of the fastest oscillation: their error is below 1e-9
/// in each, while no pad gains or loses contact in it.
inline constexpr double usual_steps_per_period = 16.0;

/// A brake in a simulation. Its inputs begin as its model has them.
class BrakeSimulation final : public fmu::Simulation {
 public:
  explicit BrakeSimulation(BrakeModel model);

  void reset() override;
  std::vector<double> values(std::span<const std::uint32_t> references) const override;
  void set_value(std::uint32_t reference, double value) override;
  double time() const override { return time_; }
  void set_time(double time) override { set_value(BrakeReferences::time, time); }
  Eigen::VectorXd continuous_states() const override { return x_; }
  void set_continuous_states(const Eigen::VectorXd& x) override;
  Eigen::VectorXd derivatives() const override;
  /// @throws chladni::Error always: the FMU says that it has none.
  std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                              const fmu::Direction& direction) const override;
  /// In steps of the method of order 8 by Dormand and Prince.
  void advance(double h) override;
  Eigen::VectorXd snapshot() const override;
  void restore(const Eigen::VectorXd& snapshot) override;

 private:
  Eigen::VectorXd rate(const Eigen::VectorXd& x) const;
  double variable(std::uint32_t reference, const Eigen::VectorXd& rates) const;

  std::unique_ptr<const BrakeModel> model_;  ///< at one place: the disc refers to it
  BrakeReferences references_;
  mutable DrivenDisc disc_;  ///< with what it computed last
  double time_ = 0.0, steps_per_period_ = usual_steps_per_period;
  Drive drive_;
  Eigen::VectorXd x_;  ///< [1 + 2 n_modes] angle, q, q'
};

}  // namespace chladni::brake_fmu
