#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The rigid-body motions that supports leave to one body.
struct FreePart {
  int n_nodes;             ///< number of nodes with DOFs of their own
  Eigen::Vector3d centre;  ///< m, mean of these nodes
  /// [6 n_pieces x n] orthonormal. A body has several pieces where springs alone connect them; each
  /// has a translation and, in units of 1/length, a rotation about the centre.
  Eigen::MatrixXd motions;
};

/// The bodies that can still move as rigid ones when the held DOFs, and the components that the
/// nodes do not have, are zero. They are found from the geometry, because a factor of K is no
/// reliable indicator: a soft spring holds a stiff body as well as a hard one. Of a mesh of one
/// sector they are those of the whole body, whose pieces may hang together through other sectors;
/// supports and springs are the same in all of them.
/// @param held  ascending, the same on every rank
std::vector<FreePart> free_parts(const mesh::Mesh& mesh, const DofMap& dofs,
                                 const std::vector<int>& held,
                                 std::span<const Spring> springs = {});

/// The held DOFs and springs of a body, and the axes about which held rotations have no effect.
struct Restraints {
  const std::vector<int>& held;          ///< ascending, the same on every rank
  std::span<const Spring> springs = {};  ///< between bodies, or to the ground
  const Eigen::MatrixX3d& axes;          ///< [n_nodes x 3] unit vectors or zero
};

/// The bodies that can still move, as by `free_parts`, if a held rotation has no effect about the
/// axis of its node.
std::vector<FreePart> free_parts_under(const mesh::Mesh& mesh, const DofMap& dofs,
                                       const Restraints& restraints);

/// The number of motions of all parts.
int n_free_motions(const std::vector<FreePart>& parts);

/// A text such as `3 ways (translation along y, rotation about x, ...)`.
std::string describe_motions(const FreePart& part);

/// Checks that no node has an empty row of K.
/// @throws chladni::Error when a node of the mesh neither belongs to an element nor follows a
///         coupling, or nothing holds a coupling.
void check_stiffness_of_all_nodes(const mesh::Mesh& mesh, const DofMap& dofs);

}  // namespace chladni::plate
