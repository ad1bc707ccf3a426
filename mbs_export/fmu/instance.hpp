#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mbs_export/fmu/modal_model.hpp"
#include "mbs_export/fmu/simulation.hpp"

namespace chladni::fmu {

/// State and inputs of a simulation.
struct State {
  double time = 0.0;               ///< s
  double damping_factor = 1.0;     ///< factor on the body's own damping matrix C
  Eigen::VectorXd damping_ratios;  ///< [n_modes] modal damping ratios D, added to C as 2 D omega q'
  Eigen::VectorXd F;               ///< [n_dofs] applied forces and moments, N, N m
  Eigen::VectorXd q, q_dot;        ///< [n_modes] modal coordinates and rates
};

/// A modal body in a simulation, accessed by the value references of its variables.
class Instance final : public Simulation {
 public:
  explicit Instance(ModalModel model);

  const State& state() const { return state_; }

  void reset() override;
  std::vector<double> values(std::span<const std::uint32_t> references) const override;
  void set_value(std::uint32_t reference, double value) override;
  double time() const override { return state_.time; }
  void set_time(double time) override { set_value(References::time, time); }
  Eigen::VectorXd continuous_states() const override;  ///< [2 n_modes] q and q'
  void set_continuous_states(const Eigen::VectorXd& x) override;
  Eigen::VectorXd derivatives() const override;  ///< [2 n_modes] q' and q''
  std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                              const Direction& direction) const override;
  void advance(double h) override;
  Eigen::VectorXd snapshot() const override;
  void restore(const Eigen::VectorXd& snapshot) override;

 private:
  Eigen::MatrixXd damping() const;
  State change_along(const Direction& direction) const;
  Eigen::VectorXd acceleration(const State& state) const;  ///< q''
  std::vector<double> values_in(const State& state,
                                std::span<const std::uint32_t> references) const;
  class Evaluation;

  std::shared_ptr<const ModalModel> model_;
  References references_;
  State state_;

  /// The propagator of the last step, reused while step size and damping do not change.
  struct Kept {
    double h, damping_factor;
    Eigen::VectorXd damping_ratios;
    Propagator propagator;
  };
  std::optional<Kept> kept_;
};

}  // namespace chladni::fmu
