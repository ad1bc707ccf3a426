#pragma once

#include "plate/assembly/inertia_integrals.hpp"
#include "plate/elements/mass_points.hpp"

namespace chladni::plate {

/// Mass points of an element, and the places where it has its DOFs.
struct PlacedPoints {
  MassPoints points;
  NodeVectors arms;  ///< [n x 3] m, from the nodes of the mesh to the DOFs; empty for zero
};

/// The mass points of an element of the model's mesh.
PlacedPoints element_points(const MassModel& model, const mesh::ElementBlock& block, int element);

/// Number of columns of MassMoments::displacement.
constexpr Eigen::Index n_moments = 12;

/// The contribution of an element to MassMoments::displacement: sums of (1, x) u_l dm over its
/// points.
/// @return [6 n_nodes x 12]
Eigen::MatrixXd element_moments(const MassPoints& points);

}  // namespace chladni::plate
