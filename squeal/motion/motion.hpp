#pragma once

#include <Eigen/Core>

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

}  // namespace chladni::squeal
