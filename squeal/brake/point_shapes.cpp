#include "squeal/brake/point_shapes.hpp"

namespace chladni::squeal {

PointShapes::PointShapes(const Disc& disc) : disc_rings_(disc.rings) {}

std::vector<RingShapes>& PointShapes::with_patch(double patch)
{
  const auto known = rings_.find(patch);
  if (known != rings_.end()) return known->second;
  std::vector<RingShapes>& shapes = rings_[patch];
  for (DiscRing ring : disc_rings_) {
    for (Harmonics* f : {&ring.W, &ring.W_r, &ring.W_t, &ring.V_r, &ring.V_t})
      for (Eigen::Index d = 0; d < f->cosine.rows(); ++d) {
        const double mean = mean_over_patch(static_cast<int>(d), patch);
        f->cosine.row(d) *= mean;
        f->sine.row(d) *= mean;
      }
    shapes.emplace_back(ring);
  }
  return shapes;
}

const Eigen::MatrixXd& PointShapes::at(const PointPair& point, double angle)
{
  std::vector<RingShapes>& rings = with_patch(point.patch);
  const Eigen::MatrixXd& upper = rings[point.rings[0]].at(point.angle - angle);
  if (upper.cols() == middle_rows) return upper;
  both_.resize(upper.rows(), 2 * face_rows);
  both_.leftCols<face_rows>() = upper;
  both_.rightCols<face_rows>() = rings[point.rings[1]].at(point.angle - angle);
  return both_;
}

Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point)
{
  const auto of_ring = [&](std::size_t ring) {
    Eigen::MatrixXd shapes = matrix_of(shapes_at(disc, disc.rings[ring], point.angle));
    for (Eigen::Index i = 0; i < shapes.rows(); ++i) {
      shapes.row(i) *=
          mean_over_patch(disc.nodal_diameters[static_cast<std::size_t>(i)], point.patch);
    }
    return shapes;
  };
  const Eigen::MatrixXd upper = of_ring(point.rings[0]);
  if (upper.cols() == middle_rows) return upper;
  Eigen::MatrixXd both(upper.rows(), 2 * face_rows);
  both << upper, of_ring(point.rings[1]);
  return both;
}

}  // namespace chladni::squeal
