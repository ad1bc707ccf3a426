#include "mesh/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "common/error.hpp"

namespace chladni::mesh {

namespace {

/// Fowler-Noll-Vo hash, variant 1a, 64 bits.
class Fnv1a {
 public:
  template <typename T>
  void add(std::span<const T> values)
  {
    for (const std::byte b : std::as_bytes(values))
      state_ = (state_ ^ std::to_integer<std::uint64_t>(b)) * 1099511628211ULL;
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

}  // namespace

const Group& find_group(const Mesh& mesh, const std::string& name)
{
  const auto it = std::ranges::find(mesh.groups, name, &Group::name);
  if (it != mesh.groups.end()) return *it;
  std::vector<std::string> names;
  for (const Group& g : mesh.groups) names.push_back(g.name);
  throw Error(fmt::format("the mesh has no group \"{}\"; its groups are: {}", name,
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void drop_unused_nodes(Mesh& mesh, std::span<const std::string> kept)
{
  std::vector<int> renumbered(mesh.positions.size(), -1);
  for (const ElementBlock& block : mesh.blocks)
    for (const int node : block.nodes) renumbered[node] = 0;
  for (const Group& group : mesh.groups)
    if (std::ranges::find(kept, group.name) != kept.end())
      for (const int node : group.nodes) renumbered[node] = 0;
  int n = 0;
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (renumbered[i] < 0) continue;
    mesh.positions[n] = mesh.positions[i];
    mesh.node_numbers[n] = mesh.node_numbers[i];
    renumbered[i] = n++;
  }
  mesh.positions.resize(n);
  mesh.node_numbers.resize(n);
  for (ElementBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = renumbered[node];
  for (Group& group : mesh.groups) {
    for (int& node : group.nodes) node = renumbered[node];
    std::erase(group.nodes, -1);
  }
}

std::string checksum(const Mesh& mesh)
{
  Fnv1a hash;
  hash.add(std::span(mesh.positions));
  for (const ElementBlock& block : mesh.blocks) hash.add(std::span(block.nodes));
  if (mesh.sectors.count > 1) hash.add(std::span(&mesh.sectors.count, 1));
  return fmt::format("{:016x}", hash.value());
}

}  // namespace chladni::mesh
