#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "squeal/brake/contact.hpp"

namespace chladni::squeal {

/// A motion y' = f(t, y) that is smooth while each switching function s_i(t, y) keeps its side
/// (sign). The side is a state of the motion: an integrator that locates the zeros of s_i sets it;
/// other integrators call `take_sides` before each evaluation or step.
class SwitchedMotion {
 public:
  SwitchedMotion() = default;
  SwitchedMotion(const SwitchedMotion&) = delete;
  SwitchedMotion& operator=(const SwitchedMotion&) = delete;
  virtual ~SwitchedMotion() = default;

  /// The rate f(t, y) on the present sides; valid until the next call.
  virtual const Eigen::VectorXd& rate(double t, const Eigen::VectorXd& y) = 0;

  /// Switching functions s_i at the last `rate`, positive while pad i is in contact; empty when f
  /// is smooth everywhere.
  virtual const Eigen::VectorXd& switches() const = 0;

  /// The present side of s_i: 1 or -1.
  virtual double side(Eigen::Index i) const = 0;
  virtual void set_side(Eigen::Index i, double side) = 0;

  /// Sets all sides to the signs of s_i(t, y).
  void take_sides(double t, const Eigen::VectorXd& y)
  {
    rate(t, y);
    take_sides_of_rate();
  }

 protected:
  /// Sets all sides to the signs of s_i of the last `rate`.
  /// @return whether any changed
  bool take_sides_of_rate()
  {
    bool changed = false;
    for (Eigen::Index i = 0; i < switches().size(); ++i) {
      const double now = switches()[i] < 0.0 ? -1.0 : 1.0;
      changed = changed || now != side(i);
      set_side(i, now);
    }
    return changed;
  }
};

/// A motion q'' = g(t, q, q') of n coordinates, written as y' = f(t, y) with y = (diag(omega) q,
/// q'), so that all entries of y have the same unit.
class Motion : public SwitchedMotion {
 public:
  /// [n] positive scales of q, rad/s; for modal coordinates their angular frequencies.
  virtual const Eigen::VectorXd& omega() const = 0;

  /// Derivatives of g by q and by q' on the present sides.
  struct Tangent {
    Eigen::MatrixXd by_q;  ///< [n x n] 1/s^2
    Eigen::MatrixXd by_v;  ///< [n x n] 1/s
  };
  /// The derivatives of g at (t, y) on the present sides.
  virtual Tangent tangent(double t, const Eigen::VectorXd& y) = 0;
};

/// An autonomous motion x' = f(x), with the functions that a search for periodic solutions needs.
class AutonomousMotion : public SwitchedMotion {
 public:
  virtual Eigen::Index size() const = 0;  ///< number of entries of x

  /// Highest angular frequency of the motion, rad/s; it limits the time steps.
  virtual double omega_highest() const = 0;

  /// Jacobian df/dx on the present sides, [size x size], 1/s.
  virtual Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) = 0;

  /// Contact state of the first pad pair at x by the full contact law.
  virtual ContactResult<double> first_contact(const Eigen::VectorXd& x) = 0;

  /// Number of evaluations of all contact forces so far. A derivative counts once for each
  /// direction, which is six for a disc, according to its cost.
  std::int64_t n_evaluations() const { return n_evaluations_; }

  /// f(x) with the sides that belong to x.
  Eigen::VectorXd rate_at(const Eigen::VectorXd& x)
  {
    const Eigen::VectorXd f = rate(0.0, x);
    return take_sides_of_rate() ? rate(0.0, x) : f;
  }

 protected:
  std::int64_t n_evaluations_ = 0;
};

/// The motion as a function of the speed (rad/s).
using AutonomousMotionAt = std::function<std::unique_ptr<AutonomousMotion>(double speed)>;

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
};

/// Work of an integration so far.
struct IntegrationCost {
  std::int64_t n_steps = 0;
  std::int64_t n_rejected = 0;
  std::int64_t n_factorizations = 0;
  std::int64_t n_events = 0;  ///< number of located changes of sides
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
