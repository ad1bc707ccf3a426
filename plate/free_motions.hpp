#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plate/assemble.hpp"

namespace chladni::plate {

/// The rigid-body motions that are left to one connected part of the body, without force.
struct FreePart {
  int n_nodes;             ///< that have DOFs of their own
  Eigen::Vector3d centre;  ///< m, the mean of these nodes
  /// [6 x n] orthonormal: translation and, in units of 1/length, rotation about the centre.
  Eigen::MatrixXd motions;
};

/// The parts of the body that can still move as rigid ones when the held DOFs do not. Found from
/// geometry, since a factor of K tells nothing reliable about them, and confirmed by K: a motion
/// that a spring resists does not count.
/// @param held  ascending, the same on every rank.
/// @note   Collective on the communicator of `system.K`.
std::vector<FreePart> free_parts(const mesh::Mesh& mesh, const System& system,
                                 const std::vector<int>& held);

/// The sum of the numbers of motions.
int n_free_motions(const std::vector<FreePart>& parts);

/// `3 ways (translation along y, rotation about x, ...)`.
std::string describe_motions(const FreePart& part);

/// @throws chladni::Error when a node of the mesh neither belongs to an element nor follows a
///         coupling, or a coupling has nothing to hold it: their rows of K are empty.
void check_stiffness_of_all_nodes(const mesh::Mesh& mesh, const DofMap& dofs);

}  // namespace chladni::plate
