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

  /// [n_modes x 3 or 5], columns W, W_r, W_t and, where pads feel them, V_r, V_t at the angle
  /// `theta` (rad); valid until the next call.
  const Eigen::MatrixXd& at(double theta);

 private:
  std::vector<int> orders_;       ///< harmonics that are not zero
  Eigen::MatrixXd coefficients_;  ///< [n_columns n_modes x 2 n_orders]: cosine and sine in turn
  Eigen::VectorXd waves_;         ///< [2 n_orders] cos(k theta), sin(k theta)
  Eigen::MatrixXd shapes_;
};

}  // namespace chladni::squeal
