#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact.hpp"
#include "squeal/models/brake.hpp"

namespace chladni::squeal {

/// A brake without a body: a few autonomous differential equations x' = f(x; speed) with the
/// sliding equilibrium at x = 0.
class LumpedBrake : public Brake {
 public:
  const LumpedBrake* lumped() const override { return this; }

  /// The number of entries of x.
  virtual Eigen::Index size() const = 0;

  /// f(x; speed)
  virtual Eigen::VectorXd rate(const Eigen::VectorXd& x, double speed) const = 0;

  /// The first pad pair at x.
  virtual ContactResult<double> contact(const Eigen::VectorXd& x, double speed) const = 0;

  /// The state at rest in which the first pads are displaced by so much, m.
  virtual Eigen::VectorXd start(double displacement) const = 0;

  /// The height z of the first upper pad at x = 0, m.
  virtual double rest_height() const = 0;
};

}  // namespace chladni::squeal
