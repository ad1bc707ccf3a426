#pragma once

#include <Eigen/SparseCore>

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Integration points on the surface of the body; of the half z > 0 alone in a half space.
struct BodySurface {
  Eigen::MatrixXd x;       ///< [n_points x 2 or 3] m
  Eigen::MatrixXd normal;  ///< [n_points x 2 or 3] unit vectors into the air
  Eigen::VectorXd weight;  ///< [n_points] area, m^2; of a meridian: arc length times r, m^2 / rad
  Eigen::SparseMatrix<double, Eigen::RowMajor> trace;  ///< [n_points x n_nodes] value of a field

  Eigen::Index n_points() const { return weight.size(); }
};

BodySurface body_surface(const AirMesh& mesh);

/// Area of the whole surface that one point of weight 1 stands for, of a field cos(n phi) squared:
/// what an integral over the points is multiplied with.
double surface_measure(const AirMesh& mesh, int n);

}  // namespace chladni::sound
