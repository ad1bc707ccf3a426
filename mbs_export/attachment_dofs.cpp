#include "mbs_export/attachment_dofs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "mbs_export/body_options.hpp"

namespace chladni::mbs_export {

using Eigen::Index, Eigen::MatrixXd;

namespace {

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

namespace {

/// An entry of `fixed`, taken apart. A set whose own name contains a dot is found first.
struct Specification {
  const AttachmentSet& set;
  int component;  ///< -1: all
};

Specification parse(const ReducedSystem& reduced, const std::string& text)
{
  const auto whole = std::ranges::find(reduced.sets, text, &AttachmentSet::name);
  if (whole != reduced.sets.end()) return {*whole, -1};
  const std::size_t dot = text.rfind('.');
  const std::string name = text.substr(0, dot);
  const AttachmentSet& set = find_set(reduced, name);
  for (int component = 0; component < 6; ++component)
    if (component_name(component) == text.substr(dot + 1)) return {set, component};
  throw BodyOptionError("fixed",
                        fmt::format("'{}': no component '{}'; there is x, y, z, rx, ry, rz", text,
                                    text.substr(dot + 1)));
}

std::string dof_name(const ReducedSystem& reduced, const AttachmentSet& set, int node,
                     int component)
{
  const std::string name = fmt::format("{}.{}", set.name, component_name(component));
  if (set.nodes.size() == 1) return name;
  return fmt::format("{} (node {})", name,
                     reduced.attachment_nodes[static_cast<std::size_t>(node)].number);
}

/// A DOF that is held, and its row of K_r or -1.
struct Held {
  int dof;
  int row;
  std::string name;
};

}  // namespace

Eigen::MatrixXd HeldDofs::displacements(const Eigen::MatrixXd& Q) const
{
  if (are_masters()) return Q(rows, every);
  return forms * Q;
}

HeldDofs held_dofs(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  std::vector<Held> all;
  std::set<int> seen;  // the first name of a DOF that is held twice
  for (const std::string& text : fixed) {
    const auto [set, component] = parse(reduced, text);
    for (const int node : set.nodes) {
      if (component >= 0 && !has_component(reduced, node, component)) {
        throw BodyOptionError(
            "fixed", fmt::format("'{}': the reduced system has no component {} there; model.dofs "
                                 "of the scene says which it has",
                                 text, component_name(component)));
      }
      for (int c = 0; c < 6; ++c) {
        if (component >= 0 ? c != component : !has_component(reduced, node, c)) continue;
        const int dof = attachment_dof(reduced, node, c);
        if (!seen.insert(dof).second) continue;
        all.push_back(
            {dof, master_row(reduced, node, c).value_or(-1), dof_name(reduced, set, node, c)});
      }
    }
  }
  std::ranges::stable_sort(all, {}, &Held::row);
  HeldDofs held;
  for (const Held& one : all) {
    held.dofs.push_back(one.dof);
    held.rows.push_back(one.row);
    held.names.push_back(one.name);
  }
  if (!held.rows.empty() && held.rows.front() < 0)
    held.forms = reduced.ring_motion->displacements(held.dofs, every);
  return held;
}

bool are_same_support(const ReducedSystem& reduced, const std::vector<std::string>& one,
                      const std::vector<std::string>& other)
{
  if (one == other) return true;
  const auto dofs_of = [&](const std::vector<std::string>& fixed) {
    std::vector<int> dofs = held_dofs(reduced, fixed).dofs;
    std::ranges::sort(dofs);
    return dofs;
  };
  return dofs_of(one) == dofs_of(other);
}

}  // namespace chladni::mbs_export
