#pragma once

#include <array>

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// An element's mass as points dm at x whose displacement u = N d is linear in its DOFs d, so that
/// every integral over the mass of positions and displacements is a sum: M_e = sum dm N^T N.
struct MassPoints {
  Eigen::VectorXd dm;           ///< [n_points] kg; some of a lumped inertia may be negative
  NodeVectors x;                ///< [n_points x 3] m
  std::array<StrainRows, 3> N;  ///< x, y, z: [n_points x 6 n_nodes]
};

/// The Gauss points of the consistent mass of a shell, two through the thickness.
MassPoints shell_mass_points(mesh::Shape shape, int order, const ShellNodes& nodes, double density);

/// Of the chain of beams that `beam_matrices` makes: four Gauss points along each, four points of
/// the section that have its area and second moments. Without rotary inertia the points do not move
/// along the axis when the section turns.
/// @param x  [n x 3] nodes from end to end, m
MassPoints beam_mass_points(const NodeVectors& x, const BeamSection& section);

/// Of a rigid body that follows the motion of one node: its centre and six points on the principal
/// axes.
/// @param node  place of the node, m
MassPoints rigid_mass_points(const PointMass& mass, const Eigen::Vector3d& node);

}  // namespace chladni::plate
