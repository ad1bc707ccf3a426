#include "plate/dof_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"

namespace chladni::plate {

namespace {

std::array<double, 3> centre(const mesh::Mesh& mesh, const mesh::Group& group)
{
  std::array<double, 3> sum{};
  for (const int node : group.nodes) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.positions[node][c];
  }
  for (double& s : sum) s /= static_cast<double>(group.nodes.size());
  return sum;
}

void check_coupling(const mesh::Mesh& mesh, const RigidCoupling& coupling, const DofMap& map)
{
  const bool used =
      std::ranges::find(mesh.groups, coupling.name, &mesh::Group::name) != mesh.groups.end();
  if (used || map.reference_node(coupling.name)) {
    throw Error(
        fmt::format("coupling \"{}\": this name is already used; choose another", coupling.name));
  }
  if (mesh::find_group(mesh, coupling.group).nodes.empty()) {
    throw Error(
        fmt::format("coupling \"{}\": group \"{}\" has no nodes", coupling.name, coupling.group));
  }
}

/// Adds the reference node and makes the nodes of the group follow it.
void add_coupling(const mesh::Mesh& mesh, const RigidCoupling& coupling, DofMap& map)
{
  check_coupling(mesh, coupling, map);
  const mesh::Group& group = mesh::find_group(mesh, coupling.group);
  const int reference = static_cast<int>(map.positions.size());
  for (const int node : group.nodes) {
    if (map.reference[node] >= 0) {
      throw Error(fmt::format(
          "node {} depends on both couplings \"{}\" and \"{}\"", mesh.node_numbers[node],
          map.reference_names[map.reference[node] - map.n_mesh_nodes], coupling.name));
    }
    map.reference[node] = reference;
  }
  map.positions.push_back(centre(mesh, group));
  map.reference.push_back(-1);
  map.reference_names.push_back(coupling.name);
}

/// A reference node goes to the lowest rank among its dependents.
std::vector<int> all_owners(const DofMap& map, std::span<const int> owners, int n_ranks)
{
  std::vector<int> all(owners.begin(), owners.end());
  all.resize(map.positions.size(), n_ranks - 1);
  for (int node = 0; node < map.n_mesh_nodes; ++node) {
    if (!map.is_dependent(node)) continue;
    all[map.reference[node]] = std::min(all[map.reference[node]], owners[node]);
  }
  return all;
}

}  // namespace

std::array<double, 3> DofMap::arm(int node) const
{
  std::array<double, 3> r = positions[node];
  for (std::size_t c = 0; c < 3; ++c) r[c] -= positions[reference[node]][c];
  return r;
}

std::optional<int> DofMap::reference_node(const std::string& name) const
{
  const auto it = std::ranges::find(reference_names, name);
  if (it == reference_names.end()) return std::nullopt;
  return n_mesh_nodes + static_cast<int>(it - reference_names.begin());
}

std::vector<MotionTerm> DofMap::motion(int node) const
{
  MotionTerm term{.number = number[node], .T = Eigen::Matrix<double, 6, 6>::Identity()};
  if (is_dependent(node)) {
    const auto [x, y, z] = arm(node);
    term.T.topRightCorner<3, 3>() << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;  // theta x arm
  }
  return {term};
}

std::optional<int> DofMap::dof(int node, int component) const
{
  if (is_dependent(node)) return std::nullopt;
  return 6 * number[node] + component;
}

const std::array<const char*, 6> component_names{"x", "y", "z", "rx", "ry", "rz"};

std::vector<int> named_nodes(const mesh::Mesh& mesh, const DofMap& dofs, const std::string& name)
{
  if (const auto reference = dofs.reference_node(name)) return {*reference};
  const auto group = std::ranges::find(mesh.groups, name, &mesh::Group::name);
  if (group != mesh.groups.end()) return group->nodes;
  std::vector<std::string> names = dofs.reference_names;
  for (const mesh::Group& g : mesh.groups) names.push_back(g.name);
  throw Error(
      fmt::format("\"{}\" is neither a group or ring of the mesh nor a coupling; there are: {}",
                  name, fmt::join(names, ", ")));
}

DofMap make_dof_map(const mesh::Mesh& mesh, std::span<const RigidCoupling> couplings,
                    std::span<const int> owners, int n_ranks)
{
  DofMap map;
  map.n_mesh_nodes = mesh.n_nodes();
  map.positions = mesh.positions;
  map.reference.assign(mesh.n_nodes(), -1);
  for (const RigidCoupling& coupling : couplings) add_coupling(mesh, coupling, map);
  const std::vector<int> rank_of = all_owners(map, owners, n_ranks);
  map.number.assign(map.positions.size(), -1);
  int next = 0;
  for (int rank = 0; rank < n_ranks; ++rank) {
    map.range.push_back(next);
    for (std::size_t node = 0; node < map.number.size(); ++node) {
      if (rank_of[node] == rank && map.reference[node] < 0) map.number[node] = next++;
    }
  }
  map.range.push_back(next);
  for (std::size_t node = 0; node < map.number.size(); ++node) {
    if (map.reference[node] >= 0) map.number[node] = map.number[map.reference[node]];
  }
  return map;
}

}  // namespace chladni::plate
