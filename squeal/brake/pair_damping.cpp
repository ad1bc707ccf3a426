#include "squeal/brake/pair_damping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace chladni::squeal {

using std::numbers::pi;

Eigen::MatrixXd averaged_over_angles(const InertialDisc& inertial, const Eigen::MatrixXd& C)
{
  const int n_max = *std::ranges::max_element(inertial.nodal_diameters);
  const int n_angles = 2 * n_max + 2;
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(C.rows(), C.cols());
  for (int k = 0; k < n_angles; ++k) {
    const double angle = 2.0 * pi * k / n_angles;
    Eigen::MatrixXd turn = C;
    for (Eigen::Index i = 0; i < C.cols(); ++i) turn.col(i) = turned(inertial, C.col(i), angle);
    const Eigen::MatrixXd half = turn.transpose();
    for (Eigen::Index i = 0; i < C.cols(); ++i)
      mean.row(i) += turned(inertial, half.col(i), angle).transpose() / n_angles;
  }
  return mean;
}

DampingDifference damping_difference(const InertialDisc& inertial, const Eigen::MatrixXd& C)
{
  DampingDifference largest;
  for (Eigen::Index i = 0; i < inertial.n_modes(); ++i) {
    if (inertial.nodal_diameters[static_cast<std::size_t>(i)] == 0) continue;
    const double half_difference = 0.5 * (C(i, i) - C(i + 1, i + 1));
    const double across = 0.5 * (C(i, i + 1) + C(i + 1, i));
    const double spread = std::hypot(half_difference, across);
    const double mean = 0.25 * (C(i, i) + C(i + 1, i + 1));
    largest.spread = std::max(largest.spread, spread);
    if (mean > 0.0) largest.contrast = std::max(largest.contrast, spread / mean);
    ++i;
  }
  return largest;
}

}  // namespace chladni::squeal
