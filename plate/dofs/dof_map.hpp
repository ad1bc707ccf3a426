#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/dofs/couplings.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// A circumferential harmonic of a ring: cos(n phi), or sin(n phi).
struct Harmonic {
  int order;  ///< n
  bool is_sine;
};

/// Harmonic k in the order 1, cos(phi), sin(phi), cos(2 phi), ...
constexpr Harmonic harmonic_of(int k)
{
  return {.order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0};
}

/// A ring that has the harmonics of its motion as DOFs.
struct HarmonicRing {
  std::string name;
  int up_to;                 ///< highest harmonic that is asked for as a master
  std::vector<int> nodes;    ///< [N] in the order of their angle
  std::vector<int> numbers;  ///< [N] active number of each harmonic k

  /// Number of harmonics 0 .. up_to with cosine and sine that N nodes can distinguish.
  int n_wanted() const { return std::min(2 * up_to + 1, static_cast<int>(nodes.size())); }
};

/// Nodes with harmonic rings. The DOFs of the harmonics of a ring take the places of those of its
/// nodes.
struct RingMotions : NodeMotions {
  std::vector<HarmonicRing> rings;
};

/// Replaces the DOFs of the nodes of rings by their harmonics. With unit vectors E_i = (e_r, e_t,
/// e_a) at node i, radial, tangential and along the axis of the circle, and the coordinates c_k =
/// (u_r, u_t, u_a, theta_r, theta_t, theta_a) of harmonic k,
///   (u, theta)_i = sum_k F_ik diag(E_i, E_i) c_k,  F_ik = a_n cos(n phi_i) or a_n sin(n phi_i)
/// for all n = 0 .. floor(N / 2). F is orthogonal, so this is another basis of the same space, and
/// harmonics beyond `up_to` are DOFs like any other. In these components a harmonic of the ring
/// belongs to motions of an axisymmetric body with the same number of nodal diameters. The axis
/// points to the side of its largest component; phi counts from the projection of the x axis, or of
/// the y axis where x is nearly the axis.
/// @throws chladni::Error for a name that is no group, fewer than three nodes, nodes that are not
///         equally spaced on a circle, nodes that follow others or are averaged, rings with a
///         common node, and a harmonic that the nodes cannot represent.
RingMotions with_ring_harmonics(const mesh::Mesh& mesh, NodeMotions motions,
                                std::span<const RingHarmonics> rings);

/// The DOFs of the FE system, the same on every rank and immutable. DOF `6 * number + component` is
/// one of (u_x, u_y, u_z, theta_x, theta_y, theta_z) of an active number; with n_c < 6 components
/// it is `n_c * number + place of the component`. In a model with solids n_c = 3, and a number
/// stands for the displacements of a node or for the rotations that it may have beside them.
class DofMap : RingMotions {
 public:
  /// @param components  ascending; the others are held at zero, except beside solids, where they
  /// are
  ///                    0 to 2. Averages and rings need all six elsewhere.
  DofMap(RingMotions motions, std::vector<int> components)
      : RingMotions(std::move(motions)), components_(std::move(components))
  {}

  using RingMotions::arm, RingMotions::followed, RingMotions::has_combined_motions,
      RingMotions::is_independent, RingMotions::is_plain, RingMotions::motion;
  using RingMotions::first_number, RingMotions::n_active, RingMotions::n_independent,
      RingMotions::number;
  /// DOFs that no motion has, as equations are solved for them; ascending.
  std::vector<int> unused_dofs() const;
  /// The numbers that the motion of a node has without the equations of the mesh.
  std::vector<int> own_numbers(int node) const;
  /// The second number of a node, of its rotations; -1 without one.
  int rotation_number(int node) const { return rotation_numbers[static_cast<std::size_t>(node)]; }
  using RingMotions::has_rotations;
  using RingMotions::is_dependent, RingMotions::n_mesh_nodes, RingMotions::n_nodes,
      RingMotions::named_nodes, RingMotions::position, RingMotions::reference,
      RingMotions::reference_name, RingMotions::reference_node;
  const CoupledNodes& coupled() const { return *this; }
  const std::vector<HarmonicRing>& harmonic_rings() const { return rings; }
  const std::vector<int>& components() const { return components_; }
  int n_components() const { return static_cast<int>(components_.size()); }
  int n_dofs() const { return n_components() * n_active(); }
  /// Whether no node has this component (0 to 5) because the model holds it at zero.
  bool holds(int component) const;
  /// The components of the motion of a node, ascending; the others are held or do not exist.
  std::vector<int> components_of(int node) const;
  /// The DOF of a component (0 to 5) of an active number; absent if the nodes do not have it.
  std::optional<int> dof_of_number(int active, int component) const;
  /// The DOF that equals this component (0 to 5) of the node's motion; absent where couplings make
  /// it a combination of others, and where the nodes do not have this component.
  std::optional<int> dof(int node, int component) const;
  /// The DOF of a component (0 to 5) of harmonic k of a ring; absent if its nodes do not have it.
  std::optional<int> harmonic_dof(const HarmonicRing& ring, int k, int component) const;

 private:
  std::optional<int> dof_at(int coordinate) const;

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
///         with fewer than six components, a node of a solid on which a shell, a beam, or what
///         follows it would hang as on a hinge; and as `with_ring_harmonics`.
DofMap make_dof_map(const mesh::Mesh& mesh, const Kinematics& kinematics,
                    std::span<const int> owners, int n_ranks);

/// The DOFs that the supports hold at zero, ascending, each once; the same on every rank.
/// @throws chladni::Error for an unknown group, a group without nodes, rotations of nodes that have
///         none, and a node whose motion follows a coupling, naming what to support instead.
std::vector<int> held_dofs(const mesh::Mesh& mesh, const DofMap& dofs,
                           std::span<const Support> supports);

}  // namespace chladni::plate
