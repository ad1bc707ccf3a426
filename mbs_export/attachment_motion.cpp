#include "mbs_export/attachment_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;

constexpr std::array component_names{"x", "y", "z", "rx", "ry", "rz"};

}  // namespace

const char* component_name(int component)
{
  return component_names[static_cast<std::size_t>(component)];
}

MatrixXd attachment_motion(const ReducedSystem& reduced, const MatrixXd& T)
{
  if (reduced.ring_motion) return reduced.ring_motion->displacements * T;
  MatrixXd motion = MatrixXd::Zero(6 * Index(reduced.attachment_nodes.size()), T.cols());
  for (Index row = 0; row < reduced.n_masters(); ++row) {
    const MasterDof& dof = reduced.masters[static_cast<std::size_t>(row)];
    motion.row(6 * dof.node + dof.component) = T.row(row);
  }
  return motion;
}

std::optional<int> master_row(const ReducedSystem& reduced, int node, int component)
{
  const auto found = std::ranges::find_if(reduced.masters, [&](const MasterDof& dof) {
    return dof.node == node && dof.component == component;
  });
  if (found == reduced.masters.end()) return std::nullopt;
  return static_cast<int>(found - reduced.masters.begin());
}

bool has_component(const ReducedSystem& reduced, int node, int component)
{
  if (!reduced.ring_motion) return master_row(reduced, node, component).has_value();
  return !reduced.ring_motion->displacements.row(6 * node + component).isZero(0.0);
}

int attachment_dof(const ReducedSystem& reduced, int node, int component)
{
  if (has_component(reduced, node, component)) return 6 * node + component;
  throw Error(fmt::format(
      "component {} of attachment node {} is not part of the reduced system; reduce again with it "
      "in the scene's [interface]",
      component_name(component), reduced.attachment_nodes[static_cast<std::size_t>(node)].number));
}

MatrixXd masters_of_motion(const ReducedSystem& reduced, const MatrixXd& motion)
{
  if (reduced.ring_motion) return reduced.ring_motion->shapes.transpose() * motion;
  MatrixXd u_m(reduced.n_masters(), motion.cols());
  for (Index row = 0; row < u_m.rows(); ++row) {
    const MasterDof& dof = reduced.masters[static_cast<std::size_t>(row)];
    u_m.row(row) = motion.row(6 * dof.node + dof.component);
  }
  return u_m;
}

}  // namespace chladni::mbs_export
