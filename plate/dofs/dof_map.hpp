#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "plate/dofs/ring_harmonics.hpp"

namespace chladni::plate {

/// The DOFs of the FE system, the same on every rank and immutable. DOF `6 * number + component` is
/// one of (u_x, u_y, u_z, theta_x, theta_y, theta_z) of an active number; with n_c < 6 components
/// it is `n_c * number + place of the component`.
class DofMap : RingMotions {
 public:
  /// @param components  ascending; the others are held at zero. Averages and rings need all six.
  DofMap(RingMotions motions, std::vector<int> components)
      : RingMotions(std::move(motions)), components_(std::move(components))
  {}

  using RingMotions::arm, RingMotions::followed, RingMotions::has_combined_motions,
      RingMotions::is_plain, RingMotions::motion;
  using RingMotions::first_number, RingMotions::n_active, RingMotions::number;
  using RingMotions::is_dependent, RingMotions::n_mesh_nodes, RingMotions::n_nodes,
      RingMotions::named_nodes, RingMotions::position, RingMotions::reference,
      RingMotions::reference_name, RingMotions::reference_node;
  const std::vector<HarmonicRing>& harmonic_rings() const { return rings; }
  const std::vector<int>& components() const { return components_; }
  int n_components() const { return static_cast<int>(components_.size()); }
  int n_dofs() const { return n_components() * n_active(); }
  /// The DOF of a component (0 to 5) of an active number; absent if the nodes do not have it.
  std::optional<int> dof_of_number(int active, int component) const;
  /// The DOF that equals this component (0 to 5) of the node's motion; absent where couplings make
  /// it a combination of others, and where the nodes do not have this component.
  std::optional<int> dof(int node, int component) const;

 private:
  std::vector<int> components_;
};

/// The names of the components: x, y, z, rx, ry, rz.
extern const std::array<const char*, 6> component_names;

/// The DOFs of a mesh, made in the steps CoupledNodes, NumberedNodes, NodeMotions and RingMotions.
/// Chains of links and rigid couplings are followed to their end.
/// @param owners  [n_mesh_nodes] rank of each node of the mesh
/// @throws chladni::Error, naming the couplings, for an unknown group, a node in two couplings,
///         links in a circle, groups of a link whose nodes do not pair, averages that overlap or
///         determine no rotation, a name that the mesh already uses, averages or harmonics of nodes
///         with fewer than six components; and as `with_ring_harmonics`.
DofMap make_dof_map(const mesh::Mesh& mesh, const Kinematics& kinematics,
                    std::span<const int> owners, int n_ranks);

}  // namespace chladni::plate
