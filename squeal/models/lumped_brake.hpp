#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// A brake without a modal body: a few autonomous differential equations x' = f(x; speed) with the
/// sliding equilibrium at x = 0.
class LumpedBrake : public Brake {
 public:
  const LumpedBrake* lumped() const override { return this; }

  /// Number of entries of x.
  virtual Eigen::Index size() const = 0;

  /// The rate f(x; speed).
  /// @param speed  rad/s
  virtual Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const = 0;

  /// Contact state of the first pad pair at x.
  virtual ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const = 0;

  /// The state at rest in which the first pads have a given displacement (m).
  virtual Eigen::VectorXd start(double displacement) const = 0;

  /// Height z of the first upper pad at x = 0, m.
  virtual double rest_height() const = 0;
};

}  // namespace chladni::squeal
