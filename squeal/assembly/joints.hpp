#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/assembly_options.hpp"

namespace chladni::squeal {

/// A modal body in the frame of the brake: q'' + C q' + diag(omega^2) q = Phi^T f.
struct Part {
  std::string name;
  std::string file;
  Eigen::VectorXd omega;       ///< [n] rad/s; 0 for rigid-body modes
  Eigen::MatrixXd C;           ///< [n x n] 1/s, zero when undamped
  Eigen::Matrix3Xd positions;  ///< [3 x n_nodes] positions of the attachment nodes, m
  Eigen::MatrixXd Phi;         ///< [6 n_nodes x n] displacement u and rotation theta of each node
  Eigen::Matrix3d R;           ///< rotation from the body's axes to those of the brake
  /// [6 x n_nodes] whether any mode has this component at a node, in the body's axes.
  Eigen::Array<bool, 6, Eigen::Dynamic> moves;
  /// [3 x n_nodes] normals of smooth shells, which resist a rotation about the normal only by a
  /// numerical stiffness; zero for other nodes.
  Eigen::Matrix3Xd drilling;
  std::vector<mbs_export::AttachmentSet> sets;

  Eigen::Index n_modes() const { return omega.size(); }
};

/// The body rotated about x, y and z of the brake in this order, then translated.
Part placed(const PartOptions& options, const mbs_export::ModalBody& body);

/// The nodes of a set as columns of `positions`.
/// @param key  key of the scene for the message, such as "contact[2].face"
/// @throws chladni::Error naming key, part and file, and the sets of the part.
const std::vector<int>& nodes_of(const Part& part, const std::string& set, const std::string& key);

/// [6 x n] displacement and rotation, for each mode, of a point rigidly connected to a node of the
/// part.
Eigen::MatrixXd motion_at(const Part& part, int node, const Eigen::Vector3d& point);

/// Flags for the components x, y, z, rx, ry, rz of a motion in the axes of the brake.
using Components = std::array<bool, 6>;

/// The components that a node must have so that a point rigidly connected to it has the components
/// `of_point`.
/// @param arm        vector from the node to the point, m
/// @param tolerance  error of node positions, m
Components needed_of_node(const Components& of_point, const Eigen::Vector3d& arm, double tolerance);

/// Checks that the modes of a part move the nodes of a set in these components.
/// @param key     key of the scene for messages, such as "contact[2].face"
/// @param remedy  what to do, for the message
/// @throws chladni::Error naming key, component, part, file and set, when the body lacks a
///         component at all of these nodes, or when a node that moves has no rotations.
void require_components(const Part& part, const std::string& set, const Components& needed,
                        const std::string& key, const std::string& remedy);

/// Checks that none of these components contains a rotation about the normal of a smooth shell at a
/// node of the set.
/// @throws chladni::Error naming key, component, part, file and set.
void refuse_drilling(const Part& part, const std::string& set, const Components& components,
                     const std::string& key);

/// Axes about which the rotations of two nodes may be joined: an orthonormal basis of the
/// directions perpendicular to the shell normals there.
/// @param normals  one column for each node, zero for none
/// @return [3 x 0 to 3]
Eigen::Matrix3Xd axes_without_drilling(const Eigen::Matrix<double, 3, 2>& normals);

/// Equations of all parts on their joints, without contact: q'' + C q' + K q = f with the
/// constraints B q = 0 of the rigid joints.
struct JoinedParts {
  Eigen::MatrixXd K;               ///< [n x n] 1/s^2
  Eigen::MatrixXd C;               ///< [n x n] 1/s
  Eigen::MatrixXd B;               ///< [n_rigid x n] constraints, m or rad per unit of q
  std::vector<std::string> notes;  ///< notes about rigid joints that leave parts few motions
};

/// Joins the parts.
/// @param parts  parts that do not rotate, in the order of their coordinates
/// @throws chladni::Error naming the joint, for a set that a part does not have, sets of different
///         size, nodes farther apart than the span of the joint, and components that a body lacks
///         there or resists only by a numerical stiffness.
JoinedParts joined(std::span<const Part> parts, std::span<const JointOptions> joints);

/// Index of the first coordinate of each part, and the number of all coordinates at the end.
std::vector<Eigen::Index> first_coordinates(std::span<const Part> parts);

/// Index of the part with this name.
std::size_t part_index(std::span<const Part> parts, const std::string& name);

/// Orthonormal basis T of the motions with B T = 0; unit modal masses remain 1.
/// @return [n x n - rank(B)]
Eigen::MatrixXd null_space(const Eigen::MatrixXd& B);

}  // namespace chladni::squeal
