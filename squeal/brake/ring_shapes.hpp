#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// `shapes_at` for many angles: the same values without an allocation, and without the harmonics
/// that are zero.
class RingShapes {
 public:
  explicit RingShapes(const DiscRing& ring);

  /// [n_modes x 3], columns W, W_r, W_t at the angle `theta` (rad); valid until the next call.
  const Eigen::MatrixX3d& at(double theta);

 private:
  std::vector<int> orders_;       ///< harmonics that are not zero
  Eigen::MatrixXd coefficients_;  ///< [3 n_modes x 2 n_orders]: cosine and sine of each in turn
  Eigen::VectorXd waves_;         ///< [2 n_orders] cos(k theta), sin(k theta)
  Eigen::MatrixX3d shapes_;
};

}  // namespace chladni::squeal
