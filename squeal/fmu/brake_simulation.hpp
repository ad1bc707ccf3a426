#pragma once

#include <cstdint>
#include <memory>

#include "mbs_export/fmu/simulation.hpp"
#include "squeal/fmu/driven_brake.hpp"

namespace chladni::brake_fmu {

/// The outputs of an FMU for one pad, in the order of their value references; forces act on the
/// disc.
enum class PadOutput {
  normal_force,
  axial_force,
  radial_force,
  tangential_force,
  height,
  velocity
};
inline constexpr int n_pad_outputs = 6;

/// Value references of the variables of a brake FMU. Each function returns the first reference of
/// its group.
class BrakeReferences {
 public:
  BrakeReferences(Eigen::Index n_modes, std::size_t n_pads)
      : n_modes_(static_cast<std::uint32_t>(n_modes)), n_pads_(static_cast<std::uint32_t>(n_pads))
  {}
  static constexpr std::uint32_t time = 0, steps_per_period = 1, speed = 2, friction = 3;
  std::uint32_t preloads() const { return 4; }
  std::uint32_t torque() const { return preloads() + n_pads_; }
  /// First reference of the pad outputs: for each pad pair those of the upper pad, then of the
  /// lower.
  std::uint32_t pads() const { return torque() + 1; }
  std::uint32_t angle() const { return pads() + 2 * n_pad_outputs * n_pads_; }
  std::uint32_t q() const { return angle() + 1; }
  std::uint32_t q_dot() const { return q() + n_modes_; }
  std::uint32_t der_angle() const { return q_dot() + n_modes_; }
  std::uint32_t der_q() const { return der_angle() + 1; }
  std::uint32_t der_q_dot() const { return der_q() + n_modes_; }
  /// One past the last reference.
  std::uint32_t end() const { return der_q_dot() + n_modes_; }

 private:
  std::uint32_t n_modes_, n_pads_;
};

/// Default number of steps of the method of order 8 per period of the fastest oscillation. The
/// error of a step is then below 1e-9, as long as no pad gains or loses contact in it.
inline constexpr double usual_steps_per_period = 16.0;

/// A brake in a simulation. Its inputs start with the values of the model.
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
  /// Not provided; the FMU declares that it has no directional derivatives.
  /// @throws chladni::Error always.
  std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                              const fmu::Direction& direction) const override;
  /// Advances by h (s) in equal steps of the method of order 8 by Dormand and Prince. The step is
  /// limited by the fastest oscillation and by the fastest decay.
  /// @throws chladni::Error when h is not positive, needs more than 1e9 steps, or the motion
  ///         overflows.
  void advance(double h) override;
  Eigen::VectorXd snapshot() const override;
  void restore(const Eigen::VectorXd& snapshot) override;

 private:
  Eigen::VectorXd rate(const Eigen::VectorXd& x) const;
  double variable(std::uint32_t reference, const Eigen::VectorXd& rates) const;

  std::unique_ptr<const BrakeModel> model_;  ///< on the heap, because disc_ keeps a reference to it
  BrakeReferences references_;
  mutable DrivenDisc disc_;  ///< mutable, because it keeps the result of its last evaluation
  double time_ = 0.0, steps_per_period_ = usual_steps_per_period;
  Drive drive_;
  Eigen::VectorXd x_;  ///< [1 + 2 n_modes] angle, q, q'
};

}  // namespace chladni::brake_fmu
