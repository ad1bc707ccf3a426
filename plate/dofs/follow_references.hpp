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

/// The nodes of the mesh, followed by a reference node for each rigid and averaging coupling. A
/// dependent node has no DOFs of its own: it follows its reference, which is the reference node of
/// a coupling or the node at the end of its links, as a rigid body,
///   u = u_ref + theta_ref x arm,  theta = theta_ref.
struct CoupledNodes {
  std::vector<std::array<double, 3>> positions;  ///< [n], m
  std::vector<int> references;                   ///< [n] index of the reference, -1 if independent
  /// [n] What a dependent node depends on; else empty.
  std::vector<std::string> names_followed;
  std::vector<std::string> reference_names;

  int n_nodes() const { return static_cast<int>(positions.size()); }
  int n_mesh_nodes() const { return n_nodes() - static_cast<int>(reference_names.size()); }
  Eigen::Vector3d position(int node) const { return Eigen::Vector3d(positions[node].data()); }
  /// The vector from the reference to a dependent node, m.
  Eigen::Vector3d arm(int node) const { return position(node) - position(reference(node)); }
  bool is_dependent(int node) const { return references[node] >= 0; }
  int reference(int node) const { return references[node]; }
  std::optional<int> reference_node(const std::string& name) const;
  const std::string& reference_name(int node) const
  {
    return reference_names[node - n_mesh_nodes()];
  }
  /// The nodes of a group or ring, or the reference node of a coupling.
  /// @throws chladni::Error when there is no such name, naming those that exist.
  std::vector<int> named_nodes(const mesh::Mesh& mesh, const std::string& name) const;
};

/// The nodes of the mesh and the reference nodes of the couplings. Each dependent node has the
/// reference at the end of its chain.
/// @throws chladni::Error as `make_dof_map` for rigid couplings and links.
CoupledNodes follow_references(const mesh::Mesh& mesh, std::span<const Coupling> couplings);

/// The name of a coupling for messages: `coupling "hub"` or `link of "wall_foot" to "wall_seat"`.
std::string describe(const Coupling& coupling);

}  // namespace chladni::plate
