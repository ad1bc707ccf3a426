#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The matrices of a lumped mass, or of a spring with its damper, at its one or two nodes.
struct PointElement {
  std::vector<int> nodes;
  Eigen::MatrixXd K, M, C;   ///< [6 n squared]; empty where nothing is added
  double loss_factor = 0.0;  ///< of K
};

/// The point elements of all masses and springs, in their order.
/// @throws chladni::Error for an unknown name, a group without nodes, a spring between several
///         nodes or from a node to itself, for what acts about a drilling axis (drilling.hpp), and
///         for moments at nodes of solids, which have no rotations.
std::vector<PointElement> point_elements(const mesh::Mesh& mesh, const Structure& structure,
                                         const DofMap& dofs);

/// A spring between two nodes, or from one node to the ground.
struct PlacedSpring {
  std::vector<int> nodes;
  std::vector<int> components;  ///< those with a stiffness
};

/// The springs at their nodes. In a group each node has its own spring to the ground. Dampers
/// without stiffness are left out.
/// @throws chladni::Error as `point_elements`.
std::vector<PlacedSpring> place_springs(const mesh::Mesh& mesh, const DofMap& dofs,
                                        std::span<const Spring> springs);

/// M of a rigid body in the displacement and rotation of the node to which it is fixed,
///   [m I, -m c~; m c~, J - m c~ c~],   c = offset.
Eigen::Matrix<double, 6, 6> point_mass_matrix(const PointMass& mass);

/// B^T diag(k) B, with B the relative motion of two nodes at the point midway between them.
/// @param ab  from the first node to the second, m
Eigen::Matrix<double, 12, 12> spring_matrix(const std::array<double, 6>& k,
                                            const Eigen::Vector3d& ab);

}  // namespace chladni::plate
