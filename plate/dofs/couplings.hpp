#pragma once

#include <Eigen/Core>

#include <array>
#include <map>
#include <optional>
#include <set>
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
  /// [n] In a model with solids, whether the node has rotations beside its displacements; else
  /// empty, and all nodes have them.
  std::vector<char> rotating = {};

  int n_nodes() const { return static_cast<int>(positions.size()); }
  int n_mesh_nodes() const { return n_nodes() - static_cast<int>(reference_names.size()); }
  Eigen::Vector3d position(int node) const { return Eigen::Vector3d(positions[node].data()); }
  /// The vector from the reference to a dependent node, m.
  Eigen::Vector3d arm(int node) const { return position(node) - position(reference(node)); }
  bool is_dependent(int node) const { return references[node] >= 0; }
  int reference(int node) const { return references[node]; }
  /// Whether the motion of a node, or of what it follows, includes rotations.
  bool has_rotations(int node) const
  {
    return rotating.empty() || rotating[is_dependent(node) ? reference(node) : node] != 0;
  }
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

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A term T q of the motion (u, theta) of a node, with q the six coordinates of an active number,
/// or in a model with solids the first three.
struct MotionTerm {
  int number;
  Matrix6d T;
};

/// Nodes with numbers for the active ones, those that have DOFs. Each rank owns a contiguous range.
/// In a model with solids a number stands for three DOFs, and a node with rotations has a second
/// one for these.
struct NumberedNodes : CoupledNodes {
  std::vector<int> numbers;           ///< [n] -1 where the node has no DOFs of its own
  std::vector<int> rotation_numbers;  ///< [n] -1 where there is no second number
  std::vector<int> first_numbers;     ///< [n_ranks + 1] first number of each rank

  int number(int node) const { return numbers[node]; }
  /// The number of nodes with DOFs of their own.
  int n_independent() const;
  /// The coordinate of an active number that a component (0 to 5) of the motion of such a node is,
  /// as 6 * number + place; -1 if the node does not have the component.
  int coordinate(int node, int component) const;
  /// The motion of such a node by its own numbers.
  std::vector<MotionTerm> own_motion(int node) const;
  int first_number(int rank) const { return first_numbers[rank]; }
  int n_active() const { return first_numbers.back(); }
};

/// Numbers the active nodes. A reference node belongs to the lowest rank among its dependents.
/// @param owners  [n_mesh_nodes] rank of each node of the mesh
NumberedNodes number_nodes(CoupledNodes coupled, std::span<const Coupling> couplings,
                           std::span<const int> owners, int n_ranks);

/// The matrix with a x b = cross_matrix(a) b.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a);

/// The matrix from the motion (u, theta) of a point to the motion (u + theta x arm, theta) of a
/// point that follows it as a rigid body.
/// @param arm  m
Matrix6d rigid_arm(const Eigen::Vector3d& arm);

/// The motion of a node as a combination of DOFs of other nodes: by an averaging coupling, or as
/// the sum of the harmonics of a ring.
struct CombinedMotion {
  /// Name of the coupling or ring; empty for the reference node of the coupling.
  std::string followed;
  std::vector<MotionTerm> terms;
  /// The coordinate that equals each component of the motion, as 6 * number + place; -1 if there is
  /// none.
  std::array<int, 6> coordinates;
  /// Whether nodes on faces make it, by which all motions remain what the geometry says.
  bool by_faces = false;
  /// Where equations of the mesh change it: the number of terms that it has without them, which
  /// come first.
  int n_own = 0;
};

/// Nodes with averaging couplings. Such a coupling replaces six displacements of nodes of its group
/// by the motion of its reference node, whose DOFs take their places.
struct NodeMotions : NumberedNodes {
  std::map<int, CombinedMotion> combined;  ///< by node
  /// Coordinates, as 6 * number + place, that no motion has, ascending: equations are solved for
  /// them.
  std::vector<int> unused = {};

  /// Whether DOFs are other than the motions of the places of their nodes.
  bool has_combined_motions() const;
  /// True if the motion of a node is that of its own DOFs.
  bool is_independent(int node) const { return !is_dependent(node) && !combined.contains(node); }
  /// True if these DOFs are those of one active number.
  bool is_plain(int node) const { return is_independent(node) && rotation_numbers[node] < 0; }
  /// The terms whose sum is the motion of a node.
  std::vector<MotionTerm> motion(int node) const;
  /// The name of the coupling or ring that the motion of a node depends on; empty for none.
  const std::string& followed(int node) const;
};

/// The motions of nodes with nodes on faces, u_k = sum_j w_kj u_j. These equations are solved for
/// as many of the u_j: of each k for a node that no other k has, as far as there is one with a
/// weight that is not small, else by pivoting. A node on a face takes the number of the node that
/// it was solved for, which becomes a combination of the others.
/// @throws chladni::Error when a node on a face follows a coupling, when the nodes of a ring are
///         closer than the mesh can tell apart, or when no node of a face stands on its own DOFs.
NodeMotions face_motions(const mesh::Mesh& mesh, NumberedNodes nodes);

/// The motions of nodes with averaging couplings. With x_i the nodes of the group, w_i their
/// group_shares divided by the sum of these, c = sum w_i x_i and r_i = x_i - c, the reference node
/// moves by
///   theta_ref = J^-1 sum w_i r_i x u_i,   J = sum w_i (r_i^2 I - r_i r_i^T),
///   u_ref = sum w_i u_i + theta_ref x (x_ref - c),
/// the rigid motion that fits the u_i best. These six equations are solved for six of the u_i,
/// chosen by pivoting: they become combinations of the others and of the motion of the reference
/// node, whose DOFs take their places. The system keeps its size, and the reference node can be
/// loaded, held or be an attachment like any other.
/// @throws chladni::Error when groups overlap or have no six independent displacements (fewer than
///         three nodes, or all of them on one line).
NodeMotions average_motions(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                            NodeMotions motions);

/// The nodes of equations that belong to no element and no coupling, and their components in
/// equations.
std::map<int, std::set<int>> nodes_of_equations_alone(const mesh::Mesh& mesh,
                                                      const CoupledNodes& nodes);

/// The motions of nodes with the equations of the mesh, each of which is solved for one coordinate:
/// that of its first term, unless another equation is solved for it or its factor is small, else
/// that of the largest factor. An equation that others imply is passed over.
/// @throws chladni::Error naming an equation with a rotation of a node that has none.
NodeMotions equation_motions(const mesh::Mesh& mesh, NodeMotions motions);

/// Writes what nodes on faces make of others anew, after the coordinates of some numbers became
/// combinations of others.
/// @param became  by number: the motion of the node that had the number
void rewrite_by_faces(NodeMotions& motions, const std::map<int, std::vector<MotionTerm>>& became);

/// int N_i ds of each node, m, over the element edges or lines that have all their nodes in the
/// group. An edge between two elements counts once. Empty if there is no such edge.
std::map<int, double> edge_shares(const mesh::Mesh& mesh, const std::string& group);

/// The share of each node in a group: int N_i dA over the elements of a group of surfaces, m^2, int
/// N_i ds over the edges of a group of curves, m, and 1 if the group has neither.
std::map<int, double> group_shares(const mesh::Mesh& mesh, const std::string& group);

}  // namespace chladni::plate
