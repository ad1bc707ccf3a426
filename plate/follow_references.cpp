#include "plate/follow_references.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

double squared_distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

int nearest_node(const mesh::Mesh& mesh, const mesh::Group& group, int node)
{
  int nearest = -1;
  double least = std::numeric_limits<double>::max();
  for (const int candidate : group.nodes) {
    const double distance = squared_distance(mesh.positions[candidate], mesh.positions[node]);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

/// What each node follows directly, and through which coupling.
class Following {
 public:
  Following(const mesh::Mesh& mesh, std::span<const Coupling> couplings, DofMap& map)
      : mesh_(mesh), couplings_(couplings), map_(map), coupling_(mesh.n_nodes(), -1)
  {}

  void add(int index);
  void follow_chains();

 private:
  void check(const Coupling& coupling) const;
  int add_reference_node(const Coupling& coupling);
  void add_link(int index);
  void follow(int node, int parent, int index);

  const mesh::Mesh& mesh_;
  std::span<const Coupling> couplings_;
  DofMap& map_;
  std::vector<int> coupling_;  ///< of each node that follows another one
};

void Following::check(const Coupling& coupling) const
{
  for (const std::string& group : {coupling.group, coupling.to}) {
    if (group.empty()) continue;
    if (mesh::find_group(mesh_, group).nodes.empty()) {
      throw Error(fmt::format("{}: group \"{}\" has no nodes", describe(coupling), group));
    }
  }
  if (coupling.kind == CouplingKind::link) return;
  const bool used =
      std::ranges::find(mesh_.groups, coupling.name, &mesh::Group::name) != mesh_.groups.end();
  if (used || map_.reference_node(coupling.name)) {
    throw Error(
        fmt::format("coupling \"{}\": this name is already used; choose another", coupling.name));
  }
}

int Following::add_reference_node(const Coupling& coupling)
{
  map_.positions.push_back(centre(mesh_, mesh::find_group(mesh_, coupling.group)));
  map_.reference.push_back(-1);
  map_.followed.emplace_back();
  map_.combined.push_back(-1);
  map_.reference_names.push_back(coupling.name);
  return static_cast<int>(map_.positions.size()) - 1;
}

void Following::follow(int node, int parent, int index)
{
  if (coupling_[node] >= 0) {
    throw Error(fmt::format("node {} depends on two couplings: {} and {}; take it out of one group",
                            mesh_.node_numbers[node], describe(couplings_[coupling_[node]]),
                            describe(couplings_[index])));
  }
  const Coupling& coupling = couplings_[index];
  coupling_[node] = index;
  map_.reference[node] = parent;
  map_.followed[node] = coupling.kind == CouplingKind::link ? coupling.to : coupling.name;
}

void Following::add_link(int index)
{
  const Coupling& link = couplings_[index];
  const mesh::Group& to = mesh::find_group(mesh_, link.to);
  std::vector<int> partner_of(mesh_.n_nodes(), -1);
  for (const int node : mesh::find_group(mesh_, link.group).nodes) {
    const int nearest = nearest_node(mesh_, to, node);
    if (nearest == node) {
      throw Error(fmt::format("{}: node {} belongs to both groups", describe(link),
                              mesh_.node_numbers[node]));
    }
    if (partner_of[nearest] >= 0) {
      throw Error(fmt::format(
          "{}: nodes {} and {} are both nearest to node {}; the nodes of the two groups must pair",
          describe(link), mesh_.node_numbers[partner_of[nearest]], mesh_.node_numbers[node],
          mesh_.node_numbers[nearest]));
    }
    partner_of[nearest] = node;
    follow(node, nearest, index);
  }
}

void Following::add(int index)
{
  const Coupling& coupling = couplings_[index];
  check(coupling);
  if (coupling.kind == CouplingKind::link) return add_link(index);
  const int reference = add_reference_node(coupling);
  if (coupling.kind == CouplingKind::averaging) return;
  for (const int node : mesh::find_group(mesh_, coupling.group).nodes) {
    follow(node, reference, index);
  }
}

/// A rigid body on a rigid body is one on the last of the chain.
void Following::follow_chains()
{
  const std::vector<int> parent = map_.reference;
  for (int node = 0; node < mesh_.n_nodes(); ++node) {
    if (parent[node] < 0) continue;
    int end = parent[node];
    int n_links = 1;
    while (parent[end] >= 0 && n_links <= mesh_.n_nodes()) {
      end = parent[end];
      ++n_links;
    }
    if (parent[end] >= 0) {
      throw Error(fmt::format("node {} follows a circle of nodes, {} and {}; take one of them out",
                              mesh_.node_numbers[node], describe(couplings_[coupling_[end]]),
                              describe(couplings_[coupling_[parent[end]]])));
    }
    map_.reference[node] = end;
  }
}

}  // namespace

std::string describe(const Coupling& coupling)
{
  return coupling.kind == CouplingKind::link
             ? fmt::format("link of \"{}\" to \"{}\"", coupling.group, coupling.to)
             : fmt::format("coupling \"{}\"", coupling.name);
}

void follow_references(const mesh::Mesh& mesh, std::span<const Coupling> couplings, DofMap& map)
{
  Following following(mesh, couplings, map);
  for (int i = 0; i < std::ssize(couplings); ++i) following.add(i);
  following.follow_chains();
}

}  // namespace chladni::plate
