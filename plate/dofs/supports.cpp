#include "plate/dofs/supports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::plate {

namespace {

[[noreturn]] void refuse_dependent(const mesh::Mesh& mesh, const DofMap& dofs,
                                   const Support& support, int node)
{
  const std::string& followed = dofs.followed(node);
  throw Error(fmt::format("support of \"{}\": node {} follows \"{}\"; support \"{}\" instead",
                          support.group, mesh.node_numbers[node], followed, followed));
}

}  // namespace

std::vector<int> held_dofs(const mesh::Mesh& mesh, const DofMap& dofs,
                           std::span<const Support> supports)
{
  std::vector<int> held;
  for (const Support& support : supports) {
    const std::vector<int> nodes = dofs.named_nodes(mesh, support.group);
    if (nodes.empty())
      throw Error(fmt::format("support of \"{}\": the group has no nodes", support.group));
    for (const int node : nodes) {
      for (const int component : support.components) {
        const auto dof = dofs.dof(node, component);
        if (!dof && dofs.is_plain(node)) continue;  // the model holds this component
        if (!dof) refuse_dependent(mesh, dofs, support, node);
        held.push_back(*dof);
      }
    }
  }
  std::ranges::sort(held);
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return held;
}

}  // namespace chladni::plate
