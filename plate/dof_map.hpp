#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The motion (u + theta x arm, theta) of a point that follows another one as a rigid body.
Matrix6d rigid_arm(const Eigen::Vector3d& arm);

/// A share T q of the motion (u, theta) of a node, with q the six coordinates of an active number.
struct MotionTerm {
  int number;
  Matrix6d T;
};

/// The motion of a node as a combination of DOFs that stand elsewhere: by an averaging coupling, or
/// as sum of the harmonics of a ring.
struct CombinedMotion {
  std::vector<MotionTerm> terms;
  std::array<int, 6> dof;  ///< the DOF that is this component of the motion, -1 where none is
};

/// A circumferential harmonic of a ring: cos(n phi), or sin(n phi).
struct Harmonic {
  int order;  ///< n
  bool is_sine;
};

/// Harmonics are counted 1, cos(phi), sin(phi), cos(2 phi), ...
constexpr Harmonic harmonic_of(int k)
{
  return {.order = (k + 1) / 2, .is_sine = k > 0 && k % 2 == 0};
}

/// A ring whose nodes have the harmonics of their motion as DOFs (ring_harmonics.hpp).
struct HarmonicRing {
  std::string name;
  int up_to;                 ///< highest harmonic that is wanted as a master
  std::vector<int> nodes;    ///< [N] by angle
  std::vector<int> numbers;  ///< [N] active number at which harmonic k stands

  /// Harmonics 0 .. up_to with cosine and sine, as far as N nodes tell them apart.
  int n_wanted() const { return std::min(2 * up_to + 1, static_cast<int>(nodes.size())); }
};

/// The nodes of the FE system: those of the mesh, then a reference node for each rigid and
/// averaging coupling. A dependent node has no DOFs of its own; it follows its reference, the
/// reference node of a coupling or the node at the end of its links, as a rigid body,
///   u = u_ref + theta_ref x arm,  theta = theta_ref.
/// An averaging coupling replaces six displacements of nodes of its group by the motion of its
/// reference node, whose DOFs stand where these were. Where a ring has its harmonics as DOFs, these
/// stand where the DOFs of its nodes were.
/// Active nodes are numbered so that each rank owns a contiguous range; the map is the same on
/// every rank. DOF `6 * number + component` (u_x, u_y, u_z, theta_x, theta_y, theta_z), or
/// correspondingly fewer where the nodes have only some of the components.
struct DofMap {
  /// [n] active number of the node or, if dependent, of its reference; -1 for the reference node of
  /// an averaging coupling
  std::vector<int> number;
  std::vector<int> reference;  ///< [n] node index of the reference, -1 for an independent node
  std::vector<std::array<double, 3>> positions;  ///< [n], m, reference nodes included
  std::vector<std::string> reference_names;
  std::vector<int> range;  ///< [n_ranks + 1] first active number of each rank
  int n_mesh_nodes = 0;
  std::vector<std::string> followed;  ///< [n] name of what a node depends on; empty for none
  std::vector<int> combined;          ///< [n] index into `combined_motions`, -1 for none
  std::vector<CombinedMotion> combined_motions;
  std::vector<HarmonicRing> harmonic_rings = {};
  std::vector<int> components = {0, 1, 2, 3, 4, 5};  ///< ascending; the others are held at zero

  int n_nodes() const { return static_cast<int>(number.size()); }
  int n_active() const { return range.back(); }
  int n_components() const { return static_cast<int>(components.size()); }
  int n_dofs() const { return n_components() * n_active(); }
  bool is_dependent(int node) const { return reference[node] >= 0; }
  std::array<double, 3> arm(int node) const;  ///< m, from the reference to a dependent node
  std::optional<int> reference_node(const std::string& name) const;

  /// The motion of a node as the sum of its terms.
  std::vector<MotionTerm> motion(int node) const;
  /// Whether the motion of a node is that of its own six DOFs.
  bool is_plain(int node) const { return reference[node] < 0 && combined[node] < 0; }
  /// The DOF of a component (0 to 5) of an active number; absent where the nodes do not have it.
  std::optional<int> dof_of_number(int active, int component) const;
  /// The DOF that is this component (0 to 5) of the node's motion; absent where couplings make it a
  /// combination of others, and where the nodes do not have this component.
  std::optional<int> dof(int node, int component) const;
};

/// The names of the components, x, y, z, rx, ry, rz.
extern const std::array<const char*, 6> component_names;

/// The nodes of a group, a ring or, one, of a coupling: indices into DofMap::positions.
/// @throws chladni::Error when there is no such name, naming those that exist.
std::vector<int> named_nodes(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& name);

/// Chains of links and rigid couplings are followed to their end.
/// @param owners [n_mesh_nodes] rank of each node of the mesh.
/// @throws chladni::Error for an unknown group, a node that two couplings claim, links in a circle,
///         groups of a link whose nodes do not pair, averages that overlap or determine no
///         rotation, or a name that the mesh already uses; each names the couplings.
DofMap make_dof_map(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                    std::span<const int> owners, int n_ranks);

}  // namespace chladni::plate
