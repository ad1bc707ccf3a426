#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "plate/elements/shell_element.hpp"

namespace chladni::plate::testing {

inline const Material steel_like{.young = 2.1, .poisson = 0.3, .density = 1.7};

/// Parent coordinates of the lattice nodes, [n x 2].
inline Eigen::MatrixX2d lattice(mesh::Shape shape, int order)
{
  std::vector<Eigen::Vector2d> points;
  const bool triangle = shape == mesh::Shape::triangle;
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i <= (triangle ? order - j : order); ++i) {
      const Eigen::Vector2d unit(double(i) / order, double(j) / order);
      points.push_back(triangle ? unit : Eigen::Vector2d(2.0 * unit.array() - 1.0));
    }
  }
  Eigen::MatrixX2d P(static_cast<Eigen::Index>(points.size()), 2);
  for (Eigen::Index k = 0; k < P.rows(); ++k) P.row(k) = points[static_cast<std::size_t>(k)];
  return P;
}

/// A curved, distorted, warped element of thickness 0.3.
inline ShellNodes curved_element(mesh::Shape shape, int order)
{
  const Eigen::MatrixX2d P = lattice(shape, order);
  ShellNodes nodes{.x = NodeVectors(P.rows(), 3), .D = NodeVectors(P.rows(), 3)};
  for (Eigen::Index k = 0; k < P.rows(); ++k) {
    const double r = P(k, 0);
    const double s = P(k, 1);
    nodes.x.row(k) << r + 0.1 * s * s + 0.2 * r * s, 0.8 * s + 0.2 * r, 0.2 * r * r + 0.1 * r * s;
    nodes.D.row(k) = 0.15 * Eigen::RowVector3d(-0.4 * r, -0.1 * r, 1.0).normalized();
  }
  return nodes;
}

inline ShellNodes rotated(const ShellNodes& nodes, const Eigen::Matrix3d& R)
{
  return {.x = nodes.x * R.transpose(), .D = nodes.D * R.transpose()};
}

/// The six rigid-body motions of all nodes, [6 n x 6].
inline Eigen::MatrixXd rigid_motions(const NodeVectors& x)
{
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(6 * x.rows(), 6);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::Vector3d r = x.row(i);
    R.block<3, 3>(6 * i, 0).setIdentity();
    R.block<3, 3>(6 * i + 3, 3).setIdentity();
    for (int axis = 0; axis < 3; ++axis)
      R.block<3, 1>(6 * i, 3 + axis) = Eigen::Vector3d::Unit(axis).cross(r);
  }
  return R;
}

}  // namespace chladni::plate::testing
