#pragma once

#include <Eigen/SparseCore>

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Integration points on the surface of the body; in a half space only those with z > 0.
struct BodySurface {
  Eigen::MatrixXd x;       ///< [n_points x 2 or 3] m
  Eigen::MatrixXd normal;  ///< [n_points x 2 or 3] unit vectors into the air
  Eigen::VectorXd weight;  ///< [n_points] area, m^2; for a meridian arc length times r, m^2 / rad
  /// [n_points x n_nodes] interpolates nodal values at the points.
  Eigen::SparseMatrix<double, Eigen::RowMajor> trace;

  Eigen::Index n_points() const { return weight.size(); }
};

/// The integration points on the body's surface of a mesh.
BodySurface body_surface(const AirMesh& mesh);

/// Factor from the sum over the integration points to the integral over the whole surface, for the
/// square of a field with cos(n phi).
double surface_measure(const AirMesh& mesh, int n);

}  // namespace chladni::sound
