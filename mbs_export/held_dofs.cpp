#include "mbs_export/held_dofs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "common/error.hpp"

namespace chladni::mbs_export {
namespace {

constexpr std::array component_names{"x", "y", "z", "rx", "ry", "rz"};

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
  const AttachmentSet& set = find_set(reduced, text.substr(0, dot));
  const auto component = std::ranges::find(component_names, text.substr(dot + 1));
  if (component == component_names.end())
    throw Error(fmt::format("'{}': no component '{}'; there is x, y, z, rx, ry, rz", text,
                            text.substr(dot + 1)));
  return {set, static_cast<int>(component - component_names.begin())};
}

std::string dof_name(const ReducedSystem& reduced, const AttachmentSet& set, MasterDof dof)
{
  const std::string name = fmt::format("{}.{}", set.name, component_name(dof.component));
  if (set.nodes.size() == 1) return name;
  const auto& node = reduced.attachment_nodes[static_cast<std::size_t>(dof.node)];
  return fmt::format("{} (node {})", name, node.number);
}

}  // namespace

const char* component_name(int component)
{
  return component_names[static_cast<std::size_t>(component)];
}

int master_row(const ReducedSystem& reduced, int node, int component)
{
  const auto found = std::ranges::find_if(reduced.masters, [&](const MasterDof& dof) {
    return dof.node == node && dof.component == component;
  });
  if (found != reduced.masters.end()) return static_cast<int>(found - reduced.masters.begin());
  throw Error(fmt::format(
      "component {} of attachment node {} is not part of the reduced system; reduce again with it "
      "in the scene's [interface]",
      component_name(component), reduced.attachment_nodes[static_cast<std::size_t>(node)].number));
}

HeldDofs held_dofs(const ReducedSystem& reduced, const std::vector<std::string>& fixed)
{
  std::map<int, std::string> names;  // by row; the first name of a DOF that is held twice
  for (const std::string& text : fixed) {
    const auto [set, component] = parse(reduced, text);
    for (const int node : set.nodes) {
      if (component >= 0) master_row(reduced, node, component);
      for (std::size_t row = 0; row < reduced.masters.size(); ++row) {
        const MasterDof dof = reduced.masters[row];
        if (dof.node == node && (component < 0 || dof.component == component))
          names.emplace(static_cast<int>(row), dof_name(reduced, set, dof));
      }
    }
  }
  HeldDofs held;
  for (const auto& [row, name] : names) {
    held.rows.push_back(row);
    held.names.push_back(name);
  }
  return held;
}

}  // namespace chladni::mbs_export
