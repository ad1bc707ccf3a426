#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// A share T q of the motion (u, theta) of a node, with q the six coordinates of an active number.
struct MotionTerm {
  int number;
  Eigen::Matrix<double, 6, 6> T;
};

/// The nodes of the FE system: those of the mesh, then one reference node for each coupling. A
/// dependent node has no DOFs of its own; it follows its reference node as a rigid body,
///   u = u_ref + theta_ref x arm,  theta = theta_ref.
/// Active nodes are numbered so that each rank owns a contiguous range; the map is the same on
/// every rank. DOF `6 * number[node] + component` (u_x, u_y, u_z, theta_x, theta_y, theta_z).
struct DofMap {
  std::vector<int> number;     ///< [n] active number of the node or, if dependent, of its reference
  std::vector<int> reference;  ///< [n] node index of the reference, -1 for an independent node
  std::vector<std::array<double, 3>> positions;  ///< [n], m, reference nodes included
  std::vector<std::string> reference_names;
  std::vector<int> range;  ///< [n_ranks + 1] first active number of each rank
  int n_mesh_nodes = 0;

  int n_nodes() const { return static_cast<int>(number.size()); }
  int n_active() const { return range.back(); }
  bool is_dependent(int node) const { return reference[node] >= 0; }
  std::array<double, 3> arm(int node) const;  ///< m, from the reference to a dependent node
  std::optional<int> reference_node(const std::string& name) const;

  /// The motion of a node as the sum of its terms.
  std::vector<MotionTerm> motion(int node) const;
  /// The DOF that is this component (0 to 5) of the node's motion; absent where couplings make it a
  /// combination of others.
  std::optional<int> dof(int node, int component) const;
};

/// The names of the components, x, y, z, rx, ry, rz.
extern const std::array<const char*, 6> component_names;

/// The nodes of a group, a ring or, one, of a coupling: indices into DofMap::positions.
/// @throws chladni::Error when there is no such name, naming those that exist.
std::vector<int> named_nodes(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& name);

/// @param owners [n_mesh_nodes] rank of each node of the mesh.
/// @throws chladni::Error for an unknown group, a node that two couplings claim, or a name that the
///         mesh already uses.
DofMap make_dof_map(const mesh::Mesh& mesh, std::span<const RigidCoupling> couplings,
                    std::span<const int> owners, int n_ranks);

}  // namespace chladni::plate
