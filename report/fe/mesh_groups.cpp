#include "report/fe/mesh_groups.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "mesh/element_parts.hpp"
#include "plate/dofs/group_shares.hpp"

namespace chladni::report {
namespace {

/// By its elements; a group without any is one of its edges, if it has some.
std::vector<GroupKind> kinds_by_elements(const mesh::Mesh& mesh)
{
  std::vector<GroupKind> kinds(mesh.groups.size(), GroupKind::points);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    const bool is_line = block.shape == mesh::Shape::line;
    for (const int group : block.group)
      if (group >= 0) kinds[group] = is_line ? GroupKind::lines : GroupKind::surface;
  }
  return kinds;
}

double sum(const std::map<int, double>& shares)
{
  double total = 0.0;
  for (const auto& [node, share] : shares) total += share;
  return total;
}

std::array<std::array<double, 2>, 3> extents_of(const mesh::Mesh& mesh, const mesh::Group& group)
{
  std::array<std::array<double, 2>, 3> extents{};
  for (std::size_t c = 0; c < 3 && !group.nodes.empty(); ++c) {
    const auto coordinate = [&](int node) { return mesh.positions[node][c]; };
    const auto [least, greatest] = std::ranges::minmax_element(group.nodes, {}, coordinate);
    extents[c] = {coordinate(*least), coordinate(*greatest)};
  }
  return extents;
}

/// The nodes of the group that no edge has.
std::vector<int> without_edges(const mesh::Group& group, const std::vector<std::vector<int>>& edges)
{
  std::vector<int> joined;
  for (const std::vector<int>& edge : edges) joined.insert(joined.end(), edge.begin(), edge.end());
  std::ranges::sort(joined);
  std::vector<int> points = group.nodes;
  std::erase_if(points, [&](int node) { return std::ranges::binary_search(joined, node); });
  return points;
}

GroupParts parts_of(const mesh::Mesh& mesh, const mesh::Group& group, GroupKind kind)
{
  GroupParts parts{.kind = kind, .edges = {}, .points = {}, .extents = extents_of(mesh, group)};
  // A curve and a surface of a file may have one name, which then means the first of them.
  const bool is_meant = &mesh::find_group(mesh, group.name) == &group;
  if (kind == GroupKind::surface) {
    if (is_meant) parts.size = sum(plate::group_shares(mesh, group.name));
    return parts;
  }
  if (group.dimension > 0) parts.edges = mesh::edges_in(mesh, group);
  parts.points = without_edges(group, parts.edges);
  if (parts.edges.empty()) return parts;
  if (is_meant) parts.size = sum(plate::edge_shares(mesh, group.name));
  if (kind == GroupKind::points) parts.kind = GroupKind::curve;
  return parts;
}

}  // namespace

std::string name_of(GroupKind kind)
{
  switch (kind) {
    case GroupKind::surface:
      return "surface";
    case GroupKind::lines:
      return "lines";
    case GroupKind::curve:
      return "curve";
    case GroupKind::points:
      break;
  }
  return "points";
}

std::vector<GroupParts> group_parts(const mesh::Mesh& mesh)
{
  const std::vector<GroupKind> kinds = kinds_by_elements(mesh);
  std::vector<GroupParts> parts;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    parts.push_back(parts_of(mesh, mesh.groups[g], kinds[g]));
  return parts;
}

}  // namespace chladni::report
