#pragma once

#include "mesh/mesh.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// K_sigma of a shell by the membrane forces N of its static displacements u_e, uniform through the
/// thickness. With the displacements u of its points and derivatives along its surface
///   v^T K_sigma v = int N_ab / t u_,a . u_,b dV.
/// All three directions of u are included, so that a rigid rotation sees the effect of the loads.
/// Moments and transverse shear forces of u_e are neglected.
/// @param nodes  D is half the thickness times the unit director
/// @param u_e    [6 n_nodes] static displacements and rotations of the mid-surface, m, rad
/// @return [6 n_nodes squared] symmetric, N/m, N, N m
/// @throws chladni::Error for an order that does not exist.
/// Source: Zienkiewicz and Taylor, The Finite Element Method 2 (2000), initial stress matrix.
Eigen::MatrixXd shell_geometric_stiffness(mesh::Shape shape, int order, const ShellNodes& nodes,
                                          const Material& material, const Eigen::VectorXd& u_e);

/// K_sigma of the line of `beam_matrices` by its axial force N, which is uniform over the section
/// and of degree p - 1 along the line. It has the terms of a string, of its twist and of the
/// bending of its section,
///   N int u'^2 + v'^2 + w'^2 + (I_y + I_z) / A phi'^2 + I_z / A psi_z'^2 + I_y / A psi_y'^2 dx.
/// @param x    [n x 3] nodes from end to end, m
/// @param u_e  [6 n] static displacements and rotations, m, rad
/// @return [6 n squared] symmetric, N/m, N, N m
/// @throws chladni::Error as `beam_axes`.
Eigen::MatrixXd beam_geometric_stiffness(const NodeVectors& x, const BeamSection& section,
                                         const Eigen::VectorXd& u_e,
                                         LineFields of_line = LineFields::best);

/// The stiffness of a force F at the end of a rigid arm r that turns with a node. The end moves by
/// theta x r + theta x (theta x r) / 2, so the forces that hold F there resist theta by
///   G = (F r^T + r F^T) / 2 - (F . r) I.
/// @param force  N, on the arm at its end: F = K u - f of what is fixed there
/// @param arm    from the node to the point, m
/// @return [3 x 3] in the rotations of the node, N m
Eigen::Matrix3d arm_geometric_stiffness(const Eigen::Vector3d& force, const Eigen::Vector3d& arm);

}  // namespace chladni::plate
