#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "squeal/motion/motion.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// How an integrator with adaptive steps chooses them.
struct StepControl {
  double tolerance;   ///< error of a step, relative to |y|
  double step_max;    ///< s
  double step_first;  ///< s
};

/// A switching function passes zero.
struct SwitchEvent {
  double t;        ///< s
  Eigen::Index i;  ///< which one
  double side;     ///< where it goes: 1 or -1

  void exchange(StateArchive& archive) { archive(t, i, side); }
};

/// What an integration took so far.
struct IntegrationCost {
  std::int64_t n_steps = 0;
  std::int64_t n_rejected = 0;
  std::int64_t n_factorizations = 0;
  std::int64_t n_events = 0;  ///< changes of a side that were located

  void exchange(StateArchive& archive) { archive(n_steps, n_rejected, n_factorizations, n_events); }
};

/// Integrates a motion with adaptive steps and dense output.
class Integrator {
 public:
  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  virtual ~Integrator() = default;

  /// y at a time that is not before the one of the last call (s); not finite when the motion leaves
  /// all numbers or no step is small enough for it. Valid until the next call.
  virtual const Eigen::VectorXd& at(double t) = 0;

  const IntegrationCost& cost() const { return cost_; }

 protected:
  IntegrationCost cost_;
};

/// Steps below this part of the largest one are taken for a divergence, and so is a velocity beyond
/// 1000 km/s, long after which no step would be small enough.
inline constexpr double step_underflow = 1e-10;
inline constexpr double state_max = 1e6;

}  // namespace chladni::squeal
