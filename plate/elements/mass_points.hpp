#pragma once

#include <array>

#include "mesh/mesh.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The mass of an element as points dm at x whose displacement u = N d is linear in its DOFs d.
/// Each integral of positions and displacements over the mass is then a sum: M_e = sum dm N^T N.
struct MassPoints {
  Eigen::VectorXd dm;           ///< [n_points] kg; may be negative for a lumped inertia
  NodeVectors x;                ///< [n_points x 3] m
  std::array<StrainRows, 3> N;  ///< x, y, z: [n_points x 6 n_nodes]
};

/// The Gauss points of the consistent mass of a shell, two through the thickness.
MassPoints shell_mass_points(mesh::Shape shape, int order, const ShellNodes& nodes, double density);

/// The mass points of the line of `beam_matrices`: the Gauss points of its mass, each with four
/// points of the section that have its area and second moments. Without rotary inertia the points
/// do not move along the axis when the section turns.
/// @param x  [n x 3] nodes from end to end, m
MassPoints beam_mass_points(const NodeVectors& x, const BeamSection& section,
                            LineFields fields = LineFields::best);

/// The mass points of a rigid body that follows the motion of one node: its centre and six points
/// on the principal axes.
/// @param node  position of the node, m
MassPoints rigid_mass_points(const PointMass& mass, const Eigen::Vector3d& node);

}  // namespace chladni::plate
