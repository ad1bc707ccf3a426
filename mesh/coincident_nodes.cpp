#include "mesh/coincident_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

using Vector = std::array<double, 3>;

double distance(const Vector& a, const Vector& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double extent(const Mesh& mesh)
{
  Vector low = mesh.positions.front();
  Vector high = low;
  for (const Vector& x : mesh.positions) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  }
  return distance(low, high);
}

/// Between neighbours in the rows of an element's nodes; zero ones are another matter.
double least_distance_in_elements(const Mesh& mesh)
{
  double least = std::numeric_limits<double>::infinity();
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const double d = distance(mesh.positions[nodes[k]], mesh.positions[nodes[k + 1]]);
        if (d > 0.0) least = std::min(least, d);
      }
    }
  }
  return least;
}

std::string list(const Mesh& mesh, const std::vector<std::array<int, 2>>& pairs)
{
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(pairs.size(), 10); ++i) {
    const auto [a, b] = pairs[i];
    text +=
        fmt::format("{}{} and {}", i == 0 ? "" : ", ", mesh.node_numbers[a], mesh.node_numbers[b]);
  }
  return pairs.size() > 10 ? text + fmt::format(" ... ({} pairs)", pairs.size()) : text;
}

void check_no_collapse(const Mesh& mesh, double tolerance)
{
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      if (std::set<int>(nodes.begin(), nodes.end()).size() == nodes.size()) continue;
      throw Error(fmt::format(
          "element {} has two nodes within the tolerance of {:.3g} m and would collapse; make "
          "merge_tolerance smaller, or repair the mesh",
          block.numbers[e], tolerance));
    }
  }
}

/// Nodes to which others were merged take over their elements and groups.
void replace_nodes(Mesh& mesh, const std::vector<int>& by)
{
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = by[node];
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = by[node];
    std::ranges::sort(group.nodes);
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
  }
}

/// Pairs that no coupling joins: not both of their nodes are in one of the groups.
std::vector<std::array<int, 2>> without_coupled(std::vector<std::array<int, 2>> pairs,
                                                const Mesh& mesh,
                                                const std::vector<std::string>& groups)
{
  std::set<int> coupled;
  for (const Group& group : mesh.groups)
    if (std::ranges::find(groups, group.name) != groups.end())
      coupled.insert(group.nodes.begin(), group.nodes.end());
  std::erase_if(pairs, [&](const auto& pair) {
    return coupled.contains(pair[0]) && coupled.contains(pair[1]);
  });
  return pairs;
}

}  // namespace

std::vector<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double tolerance)
{
  // Along a skew direction the nodes of a regular mesh lie apart, so that few come into question.
  const auto along = [&](int i) {
    const Vector& x = mesh.positions[i];
    return 0.6123724 * x[0] + 0.5412659 * x[1] + 0.5762212 * x[2];
  };
  std::vector<std::pair<double, int>> sorted(mesh.positions.size());
  for (int i = 0; i < mesh.n_nodes(); ++i) sorted[i] = {along(i), i};
  std::ranges::sort(sorted);
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto first_of_heap = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = i + 1; j < sorted.size(); ++j) {
      if (sorted[j].first - sorted[i].first > tolerance) break;
      const int a = sorted[i].second;
      const int b = sorted[j].second;
      if (distance(mesh.positions[a], mesh.positions[b]) > tolerance) continue;
      const auto [low, high] = std::minmax({first_of_heap(a), first_of_heap(b)});
      parent[high] = low;
    }
  }
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (first_of_heap(i) != i) pairs.push_back({first_of_heap(i), i});
  return pairs;
}

Mesh treat_coincident_nodes(Mesh mesh, const MeshOptions& options)
{
  const Coincident treatment = options.coincident_nodes;
  if (treatment == Coincident::keep) return mesh;
  const double within = options.merge_tolerance.value_or(
      std::min(1e-6 * extent(mesh), 0.1 * least_distance_in_elements(mesh)));
  const auto pairs = without_coupled(coincident_nodes(mesh, within), mesh, options.coupled_groups);
  if (pairs.empty()) return mesh;
  if (treatment == Coincident::refuse) {
    throw Error(fmt::format(
        "nodes of unconnected elements stand at one place (within {:.3g} m): {}; set "
        "coincident_nodes = \"merge\" in [mesh] to join them, or \"keep\" to leave the gap",
        within, list(mesh, pairs)));
  }
  std::vector<int> by(mesh.positions.size());
  std::iota(by.begin(), by.end(), 0);
  for (const auto& [kept, merged] : pairs) by[merged] = kept;
  replace_nodes(mesh, by);
  check_no_collapse(mesh, within);
  drop_unused_nodes(mesh, options.coupled_groups);
  mesh.notes.push_back(
      fmt::format("{} coincident nodes were merged (within {:.3g} m)", pairs.size(), within));
  return mesh;
}

}  // namespace chladni::mesh
