#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// Fast evaluation of `shapes_at` at many angles: without allocation and without zero harmonics.
class RingShapes {
 public:
  explicit RingShapes(const DiscRing& ring);

  /// Mode shapes at the angle `theta` (rad), columns W, W_r, W_t and, if present, V_r, V_t; valid
  /// until the next call.
  /// @return [n_modes x 3 or 5]
  const Eigen::MatrixXd& at(double theta);

 private:
  std::vector<int> orders_;       ///< harmonics that are not zero
  Eigen::MatrixXd coefficients_;  ///< [n_columns n_modes x 2 n_orders] cosine and sine alternate
  Eigen::VectorXd waves_;         ///< [2 n_orders] cos(k theta), sin(k theta)
  Eigen::MatrixXd shapes_;
};

}  // namespace chladni::squeal
