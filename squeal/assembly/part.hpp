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
  Eigen::VectorXd omega;       ///< [n] rad/s, 0 of rigid-body motions
  Eigen::MatrixXd C;           ///< [n x n] 1/s, zero when undamped
  Eigen::Matrix3Xd positions;  ///< [3 x n_nodes] of the attachment nodes, m
  Eigen::MatrixXd Phi;         ///< [6 n_nodes x n] u and theta of each node
  Eigen::Matrix3d R;           ///< from the axes of the body to those of the brake
  /// [6 x n_nodes] whether any mode moves a node so, in the axes of the body
  Eigen::Array<bool, 6, Eigen::Dynamic> moves;
  /// [3 x n_nodes] normals of smooth shells, which resist the rotation about them by a numerical
  /// stiffness alone; else zero
  Eigen::Matrix3Xd drilling;
  std::vector<mbs_export::AttachmentSet> sets;

  Eigen::Index n_modes() const { return omega.size(); }
};

/// The body turned about x, y and z of the brake, one after the other, then moved.
Part placed(const PartOptions& options, const mbs_export::ModalBody& body);

/// The nodes of a set, as columns of `positions`.
/// @param key  of the scene, for the message: "contact[2].face"
/// @throws chladni::Error naming key, part and file, and the sets that there are.
const std::vector<int>& nodes_of(const Part& part, const std::string& set, const std::string& key);

/// [6 x n] displacement and rotation of a point that is rigidly joined to a node of the part.
Eigen::MatrixXd motion_at(const Part& part, int node, const Eigen::Vector3d& point);

}  // namespace chladni::squeal
