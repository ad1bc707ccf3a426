#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/ring_shapes.hpp"

namespace chladni::squeal {

/// What the modes of a turning disc do at the point pairs of its pads.
class PointShapes {
 public:
  explicit PointShapes(const Disc& disc);

  /// [n_modes x disc rows of a point pair] when the disc has turned by `angle` (rad); valid until
  /// the next call.
  const Eigen::MatrixXd& at(const PointPair& point, double angle);

 private:
  std::vector<RingShapes> rings_;
  Eigen::MatrixXd both_;  ///< of two rings side by side
};

/// The same at a point pair of the disc in the inertial frame.
Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point);

}  // namespace chladni::squeal
