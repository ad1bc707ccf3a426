#include "squeal/assembly/part.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/error.hpp"

namespace chladni::squeal {

Part placed(const PartOptions& options, const mbs_export::ModalBody& body)
{
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const auto& [a_x, a_y, a_z] = options.rotation;
  const Eigen::Matrix3d R =
      (AngleAxisd(a_z, Vector3d::UnitZ()) * AngleAxisd(a_y, Vector3d::UnitY()) *
       AngleAxisd(a_x, Vector3d::UnitX()))
          .toRotationMatrix();
  const Vector3d origin(options.position[0], options.position[1], options.position[2]);
  const Eigen::Index n = body.n_modes(), n_nodes = std::ssize(body.attachment_nodes);
  Part part{.name = options.name,
            .file = options.body,
            .omega = body.omega,
            .C = body.C.size() > 0 ? body.C : Eigen::MatrixXd::Zero(n, n),
            .positions = Eigen::Matrix3Xd(3, n_nodes),
            .Phi = Eigen::MatrixXd(6 * n_nodes, n),
            .R = R,
            .moves = (body.attachment_modes.array() != 0.0).rowwise().any().reshaped(6, n_nodes),
            .drilling = Eigen::Matrix3Xd(3, n_nodes),
            .sets = body.sets};
  for (Eigen::Index i = 0; i < n_nodes; ++i) {
    const auto& node = body.attachment_nodes[static_cast<std::size_t>(i)];
    part.positions.col(i) = origin + R * node.position;
    part.drilling.col(i) = R * node.drilling_axis;
    for (const Eigen::Index row : {6 * i, 6 * i + 3})
      part.Phi.middleRows<3>(row) = R * body.attachment_modes.middleRows<3>(row);
  }
  return part;
}

const std::vector<int>& nodes_of(const Part& part, const std::string& set, const std::string& key)
{
  const auto found = std::ranges::find(part.sets, set, &mbs_export::AttachmentSet::name);
  if (found != part.sets.end() && !found->nodes.empty()) return found->nodes;
  std::vector<std::string> names;
  for (const auto& other : part.sets) names.push_back(other.name);
  throw Error(fmt::format("{}: part \"{}\" ({}) has no attachment nodes \"{}\"; it has: \"{}\"",
                          key, part.name, part.file, set, fmt::join(names, "\", \"")));
}

Eigen::MatrixXd motion_at(const Part& part, int node, const Eigen::Vector3d& point)
{
  Eigen::MatrixXd motion = part.Phi.middleRows<6>(6 * Eigen::Index{node});
  const Eigen::Vector3d arm = point - part.positions.col(node);
  // u + theta x arm
  for (Eigen::Index j = 0; j < motion.cols(); ++j)
    motion.col(j).head<3>() += motion.col(j).tail<3>().cross(arm).eval();
  return motion;
}

}  // namespace chladni::squeal
