#include "cli/attachments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::cli {
namespace {

void check_independent(const mesh::Mesh& mesh, const plate::DofMap& dofs, const std::string& name,
                       int node)
{
  for (const int component : dofs.components) {
    if (dofs.dof(node, component)) continue;
    const std::string& followed = dofs.followed[node];
    throw Error(
        fmt::format("interface node set \"{}\": node {} follows \"{}\"; put \"{}\" into "
                    "interface.nodes instead",
                    name, mesh.node_numbers[node], followed, followed));
  }
}

}  // namespace

std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node)
{
  if (node < dofs.n_mesh_nodes) return mesh.node_numbers[node];
  return mesh.node_numbers.back() + 1 + node - dofs.n_mesh_nodes;
}

Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names)
{
  Attachments attachments;
  for (const std::string& name : names) {
    mbs_export::AttachmentSet set{.name = name, .nodes = {}};
    for (const int node : plate::named_nodes(mesh, dofs, name)) {
      check_independent(mesh, dofs, name, node);
      const auto it = std::ranges::find(attachments.nodes, node);
      set.nodes.push_back(static_cast<int>(it - attachments.nodes.begin()));
      if (it == attachments.nodes.end()) attachments.nodes.push_back(node);
    }
    attachments.sets.push_back(std::move(set));
  }
  return attachments;
}

}  // namespace chladni::cli
