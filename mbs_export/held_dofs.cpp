#include "mbs_export/held_dofs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/eigen_every.hpp"
#include "mbs_export/attachment_motion.hpp"
#include "mbs_export/body_option_error.hpp"

namespace chladni::mbs_export {
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
