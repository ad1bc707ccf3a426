#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/ring_shapes.hpp"

namespace chladni::squeal {

/// Mode shapes of a rotating disc at the point pairs of its pads.
class PointShapes {
 public:
  explicit PointShapes(const Disc& disc);

  /// Shapes when the disc has rotated by `angle` (rad); valid until the next call.
  /// @return [n_modes x disc rows of a point pair]
  const Eigen::MatrixXd& at(const PointPair& point, double angle);

 private:
  std::vector<RingShapes> rings_;
  Eigen::MatrixXd both_;  ///< shapes of two rings side by side
};

/// Mode shapes of the disc in the inertial frame at a point pair.
/// @return [n_modes x disc rows of a point pair]
Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point);

}  // namespace chladni::squeal
