#include "plate/dof_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/error.hpp"
#include "plate/average_motions.hpp"
#include "plate/follow_references.hpp"

namespace chladni::plate {

namespace {

/// A reference node goes to the lowest rank among its dependents.
std::vector<int> all_owners(const DofMap& map, std::span<const int> owners, int n_ranks)
{
  std::vector<int> all(owners.begin(), owners.end());
  all.resize(map.positions.size(), n_ranks - 1);
  for (int node = 0; node < map.n_mesh_nodes; ++node) {
    const int reference = map.reference[node];
    if (reference < map.n_mesh_nodes) continue;
    all[reference] = std::min(all[reference], owners[node]);
  }
  return all;
}

/// The reference node of an averaging coupling has no number: its DOFs stand at its group.
std::vector<bool> have_numbers(std::span<const Coupling> couplings, const DofMap& map)
{
  std::vector<bool> have(map.positions.size(), true);
  for (std::size_t node = 0; node < have.size(); ++node) have[node] = map.reference[node] < 0;
  for (const Coupling& coupling : couplings) {
    if (coupling.kind == CouplingKind::averaging) have[*map.reference_node(coupling.name)] = false;
  }
  return have;
}

void number_nodes(std::span<const Coupling> couplings, const std::vector<int>& rank_of, int n_ranks,
                  DofMap& map)
{
  const std::vector<bool> have = have_numbers(couplings, map);
  map.number.assign(map.positions.size(), -1);
  int next = 0;
  for (int rank = 0; rank < n_ranks; ++rank) {
    map.range.push_back(next);
    for (std::size_t node = 0; node < map.number.size(); ++node) {
      if (rank_of[node] == rank && have[node]) map.number[node] = next++;
    }
  }
  map.range.push_back(next);
  for (std::size_t node = 0; node < map.number.size(); ++node) {
    if (map.reference[node] >= 0) map.number[node] = map.number[map.reference[node]];
  }
}

}  // namespace

const std::array<const char*, 6> component_names{"x", "y", "z", "rx", "ry", "rz"};

Matrix6d rigid_arm(const Eigen::Vector3d& arm)
{
  Matrix6d T = Matrix6d::Identity();
  T.topRightCorner<3, 3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(),
      0.0;  // theta x arm
  return T;
}

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
  const int end = is_dependent(node) ? reference[node] : node;
  std::vector<MotionTerm> terms;
  if (combined[end] >= 0) {
    terms = combined_motions[combined[end]].terms;
  } else {
    terms.push_back({.number = number[end], .T = Matrix6d::Identity()});
  }
  if (end == node) return terms;
  const auto [x, y, z] = arm(node);
  for (MotionTerm& term : terms) term.T = rigid_arm({x, y, z}) * term.T;
  return terms;
}

std::optional<int> DofMap::dof_of_number(int active, int component) const
{
  const auto it = std::ranges::find(components, component);
  if (it == components.end()) return std::nullopt;
  return n_components() * active + static_cast<int>(it - components.begin());
}

std::optional<int> DofMap::dof(int node, int component) const
{
  if (is_dependent(node)) return std::nullopt;
  if (combined[node] < 0) return dof_of_number(number[node], component);
  const int dof = combined_motions[combined[node]].dof[static_cast<std::size_t>(component)];
  return dof < 0 ? std::nullopt : std::optional(dof);
}

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

DofMap make_dof_map(const mesh::Mesh& mesh, std::span<const Coupling> couplings,
                    std::span<const int> owners, int n_ranks)
{
  DofMap map;
  map.n_mesh_nodes = mesh.n_nodes();
  map.positions = mesh.positions;
  map.reference.assign(mesh.n_nodes(), -1);
  map.followed.resize(mesh.n_nodes());
  map.combined.assign(mesh.n_nodes(), -1);
  follow_references(mesh, couplings, map);
  number_nodes(couplings, all_owners(map, owners, n_ranks), n_ranks, map);
  average_motions(mesh, couplings, map);
  return map;
}

}  // namespace chladni::plate
