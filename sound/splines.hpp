#pragma once

#include <Eigen/Core>

namespace chladni::sound {

/// Cubic B-splines on [0, length] with equal intervals.
class Splines {
 public:
  Splines(double length, int n_intervals);

  int size() const { return n_intervals_ + 3; }
  /// Values of all splines at s; s outside the interval is moved to its nearest end.
  Eigen::RowVectorXd values(double s) const;
  /// Derivatives of all splines by s, at the same s.
  Eigen::RowVectorXd slopes(double s) const;

 private:
  Eigen::RowVectorXd evaluate(double s, int derivative) const;

  double length_;
  int n_intervals_;
};

}  // namespace chladni::sound
