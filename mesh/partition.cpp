#include "mesh/partition.hpp"

#include <fmt/format.h>
#include <metis.h>

#include <algorithm>

#include "common/checked_count.hpp"
#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/nodal_matrices.hpp"

namespace chladni::mesh {

namespace {

/// Corner nodes of all elements, in METIS' compressed format.
struct CornerLists {
  std::vector<idx_t> start{0};
  std::vector<idx_t> corners;
};

CornerLists corner_lists(const Mesh& mesh)
{
  CornerLists lists;
  for (const ElementBlock& block : mesh.blocks) {
    const std::vector<int> places = corner_places(block);
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const int k : places) lists.corners.push_back(block.element_nodes(e)[k]);
      lists.start.push_back(
          checked_count(std::ssize(lists.corners), "corners of elements", "use a coarser mesh"));
    }
  }
  return lists;
}

std::vector<idx_t> element_parts(const Mesh& mesh, int n_parts)
{
  CornerLists lists = corner_lists(mesh);
  auto n_elements = static_cast<idx_t>(lists.start.size() - 1);
  if (n_elements < n_parts)
    throw Error(fmt::format("the mesh has {} elements, too few for {} ranks", n_elements, n_parts));
  std::vector<idx_t> parts(n_elements, 0);
  if (n_parts == 1) return parts;
  auto n_nodes = static_cast<idx_t>(mesh.n_nodes());
  auto parts_wanted = static_cast<idx_t>(n_parts);
  // Neighbours share a face, an edge, or the end of a line.
  int least = 3;
  for (const ElementBlock& block : mesh.blocks) least = std::min(least, dimension(block.shape));
  idx_t shared_nodes = least;
  idx_t cut = 0;
  std::vector<idx_t> node_parts(n_nodes);
  const int status = METIS_PartMeshDual(
      &n_elements, &n_nodes, lists.start.data(), lists.corners.data(), nullptr, nullptr,
      &shared_nodes, &parts_wanted, nullptr, nullptr, &cut, parts.data(), node_parts.data());
  if (status != METIS_OK) throw Error(fmt::format("METIS_PartMeshDual failed with {}", status));
  return parts;
}

/// By the graph of K, of a mesh with matrices.
std::vector<int> owners_by_matrices(const Mesh& mesh, int n_parts)
{
  auto n = static_cast<idx_t>(mesh.n_nodes());
  std::vector<idx_t> parts(std::size_t(n), 0);
  if (n_parts > 1) {
    std::vector<std::vector<idx_t>> neighbours(static_cast<std::size_t>(n));
    for_blocks(mesh.matrices->K, [&](std::span<const int> nodes, auto) {
      if (nodes.size() < 2) return;
      neighbours[std::size_t(nodes[0])].push_back(nodes[1]);
      neighbours[std::size_t(nodes[1])].push_back(nodes[0]);
    });
    std::vector<idx_t> start{0}, adjacent;
    for (const std::vector<idx_t>& of_node : neighbours) {
      adjacent.insert(adjacent.end(), of_node.begin(), of_node.end());
      start.push_back(checked_count(std::ssize(adjacent), "pairs of nodes", "use a coarser mesh"));
    }
    idx_t constraints = 1, cut = 0;
    auto parts_wanted = static_cast<idx_t>(n_parts);
    const int status =
        METIS_PartGraphKway(&n, &constraints, start.data(), adjacent.data(), nullptr, nullptr,
                            nullptr, &parts_wanted, nullptr, nullptr, nullptr, &cut, parts.data());
    if (status != METIS_OK) throw Error(fmt::format("METIS_PartGraphKway failed with {}", status));
  }
  return {parts.begin(), parts.end()};
}

}  // namespace

std::vector<int> node_owners(const Mesh& mesh, int n_parts)
{
  if (mesh.matrices) return owners_by_matrices(mesh, n_parts);
  const std::vector<idx_t> parts = element_parts(mesh, n_parts);
  std::vector<int> owners(mesh.n_nodes(), n_parts - 1);
  std::size_t element = 0;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e, ++element)
      for (const int node : block.element_nodes(e))
        owners[node] = std::min(owners[node], static_cast<int>(parts[element]));
  }
  return owners;
}

}  // namespace chladni::mesh
