#pragma once

#include <Eigen/Core>
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

}  // namespace chladni::squeal
