#pragma once

#include <Eigen/Core>

namespace chladni::sound {

/// Cubic B-splines on [0, length] over equal intervals.
class Splines {
 public:
  Splines(double length, int n_intervals);

  int size() const { return n_intervals_ + 3; }
  /// All splines at s, which is brought into the interval first.
  Eigen::RowVectorXd values(double s) const;
  Eigen::RowVectorXd slopes(double s) const;

 private:
  Eigen::RowVectorXd evaluate(double s, int derivative) const;

  double length_;
  int n_intervals_;
};

}  // namespace chladni::sound
