#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::plate::testing {

inline constexpr double patch_thickness = 0.05;

/// Flat patch of straight-sided distorted elements in [0, 3] x [0, 2], assembled densely.
struct Patch {
  std::vector<Eigen::Vector2d> positions;
  Eigen::MatrixXd K;
};

Patch make_patch(mesh::Shape shape, int order);

/// Displacements and rotations at a place of the plane.
using Field = std::function<Eigen::Vector<double, 6>(const Eigen::Vector2d&)>;

/// Largest error of the inner DOFs when the boundary follows `exact`, relative to the field.
double patch_error(const Patch& patch, const Field& exact);

/// Every shape and order that a patch can have.
std::vector<std::pair<mesh::Shape, int>> patch_elements();

/// Exact fields: u = x + y / 2, v = y + x / 2; w = (x^2 + x y + y^2) / 2 with its slopes; 1e-3
/// each.
Eigen::Vector<double, 6> constant_membrane_strain(const Eigen::Vector2d& x);
Eigen::Vector<double, 6> constant_curvature(const Eigen::Vector2d& x);

}  // namespace chladni::plate::testing
