#pragma once

#include <map>

#include "plate/dofs/number_nodes.hpp"

namespace chladni::plate {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The matrix with a x b = cross_matrix(a) b.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a);

/// The matrix from the motion (u, theta) of a point to the motion (u + theta x arm, theta) of a
/// point that follows it as a rigid body.
/// @param arm  m
Matrix6d rigid_arm(const Eigen::Vector3d& arm);

/// A term T q of the motion (u, theta) of a node, with q the six coordinates of an active number.
struct MotionTerm {
  int number;
  Matrix6d T;
};

/// The motion of a node as a combination of DOFs of other nodes: by an averaging coupling, or as
/// the sum of the harmonics of a ring.
struct CombinedMotion {
  /// Name of the coupling or ring; empty for the reference node of the coupling.
  std::string followed;
  std::vector<MotionTerm> terms;
  /// The DOF that equals each component of the motion; -1 if there is none.
  std::array<int, 6> dof;
};

/// Nodes with averaging couplings. Such a coupling replaces six displacements of nodes of its group
/// by the motion of its reference node, whose DOFs take their places.
struct NodeMotions : NumberedNodes {
  std::map<int, CombinedMotion> combined;  ///< by node

  bool has_combined_motions() const { return !combined.empty(); }
  /// True if the motion of a node is that of its own six DOFs.
  bool is_plain(int node) const { return !is_dependent(node) && !combined.contains(node); }
  /// The terms whose sum is the motion of a node.
  std::vector<MotionTerm> motion(int node) const;
  /// The name of the coupling or ring that the motion of a node depends on; empty for none.
  const std::string& followed(int node) const;
};

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
                            NumberedNodes nodes);

}  // namespace chladni::plate
