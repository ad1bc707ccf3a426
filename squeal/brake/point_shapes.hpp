#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/brake/ring_shapes.hpp"

namespace chladni::squeal {

/// Mode shapes of a rotating disc at the point pairs of its pads. Those of a patch are means over
/// it, as if the shapes were the same along the radius.
class PointShapes {
 public:
  explicit PointShapes(const Disc& disc);

  /// Shapes when the disc has rotated by `angle` (rad); valid until the next call.
  /// @return [n_modes x disc rows of a point pair]
  const Eigen::MatrixXd& at(const PointPair& point, double angle);

 private:
  std::vector<RingShapes>& with_patch(double patch);

  std::vector<DiscRing> disc_rings_;
  std::map<double, std::vector<RingShapes>> rings_;  ///< by the patch
  Eigen::MatrixXd both_;                             ///< shapes of two rings side by side
};

/// Mode shapes of the disc in the inertial frame at a point pair.
/// @return [n_modes x disc rows of a point pair]
Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point);

}  // namespace chladni::squeal
