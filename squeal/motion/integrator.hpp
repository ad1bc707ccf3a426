#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "squeal/motion/motion.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// Step size control of an adaptive integrator.
struct StepControl {
  double tolerance;   ///< error of a step relative to |y|
  double step_max;    ///< s
  double step_first;  ///< s
};

/// A zero of a switching function.
struct SwitchEvent {
  double t;        ///< s
  Eigen::Index i;  ///< index of the switching function
  double side;     ///< its new side: 1 or -1

  void exchange(StateArchive& archive) { archive(t, i, side); }
};

/// Work of an integration so far.
struct IntegrationCost {
  std::int64_t n_steps = 0;
  std::int64_t n_rejected = 0;
  std::int64_t n_factorizations = 0;
  std::int64_t n_events = 0;  ///< number of located changes of sides

  void exchange(StateArchive& archive) { archive(n_steps, n_rejected, n_factorizations, n_events); }
};

/// An integrator with adaptive steps and dense output.
class Integrator {
 public:
  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  virtual ~Integrator() = default;

  /// y at a time (s) that is not before the time of the last call; not finite when the motion
  /// diverges or no step is small enough. Valid until the next call.
  virtual const Eigen::VectorXd& at(double t) = 0;

  const IntegrationCost& cost() const { return cost_; }

 protected:
  IntegrationCost cost_;
};

/// A step below this fraction of the largest step counts as divergence, as does a velocity above
/// 1000 km/s, when no step would be small enough.
inline constexpr double step_underflow = 1e-10;
inline constexpr double state_max = 1e6;

}  // namespace chladni::squeal
