#pragma once

#include "plate/assembly/inertia_integrals.hpp"
#include "plate/elements/mass_points.hpp"

namespace chladni::plate {

/// Mass points of an element, and how its DOFs follow from the active ones.
struct PlacedPoints {
  MassPoints points;
  NodeVectors arms;  ///< [n x 3] from the nodes of the mesh, m; empty where they stand there
};

/// Mass points of any element of the mesh of the model.
PlacedPoints element_points(const MassModel& model, const mesh::ElementBlock& block, int element);

/// The columns of MassMoments::displacement.
constexpr Eigen::Index n_moments = 12;

/// What the DOFs of an element have of the columns of MassMoments::displacement: the sums over its
/// points of (1, x) u_l dm.
/// @return [6 n_nodes x 12]
Eigen::MatrixXd element_moments(const MassPoints& points);

}  // namespace chladni::plate
