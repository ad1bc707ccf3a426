#include "squeal/brake/point_shapes.hpp"

namespace chladni::squeal {

PointShapes::PointShapes(const Disc& disc) : rings_(disc.rings.begin(), disc.rings.end()) {}

const Eigen::MatrixXd& PointShapes::at(const PointPair& point, double angle)
{
  const Eigen::MatrixXd& upper = rings_[point.rings[0]].at(point.angle - angle);
  if (upper.cols() == middle_rows) return upper;
  both_.resize(upper.rows(), 2 * face_rows);
  both_.leftCols<face_rows>() = upper;
  both_.rightCols<face_rows>() = rings_[point.rings[1]].at(point.angle - angle);
  return both_;
}

Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point)
{
  const Eigen::MatrixXd upper = matrix_of(shapes_at(disc, disc.rings[point.rings[0]], point.angle));
  if (upper.cols() == middle_rows) return upper;
  Eigen::MatrixXd both(upper.rows(), 2 * face_rows);
  both << upper, matrix_of(shapes_at(disc, disc.rings[point.rings[1]], point.angle));
  return both;
}

}  // namespace chladni::squeal
