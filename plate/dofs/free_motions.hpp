#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The rigid-body motions that are left to one body, without force.
struct FreePart {
  int n_nodes;             ///< that have DOFs of their own
  Eigen::Vector3d centre;  ///< m, the mean of these nodes
  /// [6 n_pieces x n] orthonormal: of each piece that springs alone connect to the others,
  /// translation and, in units of 1/length, rotation about the centre.
  Eigen::MatrixXd motions;
};

/// The bodies that can still move as rigid ones when the held DOFs do not, and neither do the
/// components that the nodes do not have. Found from geometry, since a factor of K tells nothing
/// reliable about them: a soft spring on a stiff body holds it as well as a hard one.
/// @param held  ascending, the same on every rank.
std::vector<FreePart> free_parts(const mesh::Mesh& mesh, const DofMap& dofs,
                                 const std::vector<int>& held,
                                 std::span<const Spring> springs = {});

/// What holds a body.
struct Restraints {
  const std::vector<int>& held;          ///< ascending, the same on every rank
  std::span<const Spring> springs = {};  ///< between bodies, or to the ground
  const Eigen::MatrixX3d& axes;          ///< [n_nodes x 3] unit vectors or zero
};

/// The same where a held rotation holds nothing as far as it is about the axis of its node.
std::vector<FreePart> free_parts_under(const mesh::Mesh& mesh, const DofMap& dofs,
                                       const Restraints& restraints);

/// The sum of the numbers of motions.
int n_free_motions(const std::vector<FreePart>& parts);

/// `3 ways (translation along y, rotation about x, ...)`.
std::string describe_motions(const FreePart& part);

/// @throws chladni::Error when a node of the mesh neither belongs to an element nor follows a
///         coupling, or a coupling has nothing to hold it: their rows of K are empty.
void check_stiffness_of_all_nodes(const mesh::Mesh& mesh, const DofMap& dofs);

}  // namespace chladni::plate
