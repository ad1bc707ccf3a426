#pragma once

#include <map>

#include "plate/dofs/number_nodes.hpp"

namespace chladni::plate {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// a x b = cross_matrix(a) b.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a);

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
  std::string followed;  ///< name of this coupling or ring; empty for the coupling's reference node
  std::vector<MotionTerm> terms;
  std::array<int, 6> dof;  ///< the DOF that is this component of the motion, -1 where none is
};

/// An averaging coupling replaces six displacements of nodes of its group by the motion of its
/// reference node, whose DOFs stand where these were.
struct NodeMotions : NumberedNodes {
  std::map<int, CombinedMotion> combined;  ///< by node

  bool has_combined_motions() const { return !combined.empty(); }
  /// Whether the motion of a node is that of its own six DOFs.
  bool is_plain(int node) const { return !is_dependent(node) && !combined.contains(node); }
  /// The motion of a node as the sum of its terms.
  std::vector<MotionTerm> motion(int node) const;
  /// The name of what the motion of a node depends on; empty for none.
  const std::string& followed(int node) const;
};

/// The motions of nodes where the reference nodes of averaging couplings move with their groups.
/// With x_i the nodes of the group, w_i their group_shares divided by the sum of these, c = sum w_i
/// x_i and r_i = x_i - c, the reference node has
///   theta_ref = J^-1 sum w_i r_i x u_i,   J = sum w_i (r_i^2 I - r_i r_i^T),
///   u_ref = sum w_i u_i + theta_ref x (x_ref - c),
/// the rigid motion that fits the u_i best. These six equations are solved for six of the u_i,
/// chosen by pivoting: they become combinations of the others and of the motion of the reference
/// node, whose DOFs take their places. The system keeps its size, and the reference node can be
/// loaded, held or be an attachment as any other.
/// @throws chladni::Error when groups overlap or have no six independent displacements (fewer than
///         three nodes, or all of them on one line).
NodeMotions average_motions(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                            NumberedNodes nodes);

}  // namespace chladni::plate
