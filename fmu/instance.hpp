#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fmu/modal_model.hpp"
#include "fmu/propagator.hpp"

namespace chladni::fmu {

/// All that changes in a simulation.
struct State {
  double time = 0.0;               ///< s
  double damping_factor = 1.0;     ///< of the body's own C
  Eigen::VectorXd damping_ratios;  ///< [n_modes] besides C: 2 D omega q'
  Eigen::VectorXd F;               ///< [n_dofs] N, N m
  Eigen::VectorXd q, q_dot;        ///< [n_modes]
};

/// A body in a simulation, by the value references of its variables.
class Instance {
 public:
  explicit Instance(ModalModel model);

  const ModalModel& model() const { return *model_; }
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }
  /// At rest, without forces, parameters as at the start.
  void reset();

  /// @throws chladni::Error for a reference that no variable has.
  std::vector<double> values(std::span<const std::uint32_t> references) const;
  /// @throws chladni::Error for a variable that is computed, and for what is no finite number.
  void set_value(std::uint32_t reference, double value);

  Eigen::VectorXd continuous_states() const;  ///< [2 n_modes] q and q'
  void set_continuous_states(const Eigen::VectorXd& x);
  Eigen::VectorXd derivatives() const;  ///< [2 n_modes] q' and q''

  /// The derivatives of the variables `unknowns` in the direction of changes of states and inputs;
  /// the model is linear in them.
  /// @param change  states and inputs that change, at their places; parameters are not looked at
  std::vector<double> directional_derivatives(std::span<const std::uint32_t> unknowns,
                                              const State& change) const;
  /// No change of anything.
  State no_change() const;
  /// @throws chladni::Error for a variable that is neither state nor input nor time.
  void add_change(State& change, std::uint32_t known, double value) const;

  /// Goes on by h > 0 seconds with the forces as they are.
  void advance(double h);

 private:
  Eigen::MatrixXd damping() const;
  Eigen::VectorXd acceleration(const State& state) const;  ///< q''
  std::vector<double> values_in(const State& state,
                                std::span<const std::uint32_t> references) const;
  class Evaluation;

  std::shared_ptr<const ModalModel> model_;
  References references_;
  State state_;

  /// Of the last step, as long as step size and damping stay.
  struct Kept {
    double h, damping_factor;
    Eigen::VectorXd damping_ratios;
    Propagator propagator;
  };
  std::optional<Kept> kept_;
};

}  // namespace chladni::fmu
