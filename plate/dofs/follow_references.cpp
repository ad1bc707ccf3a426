#include "plate/dofs/follow_references.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "common/error.hpp"

namespace chladni::plate {

namespace {

/// Whether the group goes on in the next sectors, all around the axis.
bool closes_around_axis(const mesh::Mesh& mesh, const mesh::Group& group)
{
  const auto has = [&](int node) {
    return std::ranges::find(group.nodes, node) != group.nodes.end();
  };
  return std::ranges::any_of(mesh.sectors.pairs,
                             [&](const auto& pair) { return has(pair[0]) && has(pair[1]); });
}

std::array<double, 3> centre(const mesh::Mesh& mesh, const mesh::Group& group)
{
  std::array<double, 3> sum{};
  for (const int node : group.nodes)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.positions[node][c];
  for (double& s : sum) s /= static_cast<double>(group.nodes.size());
  if (closes_around_axis(mesh, group)) return {0.0, 0.0, sum[2]};
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
  Following(const mesh::Mesh& mesh, std::span<const Coupling> couplings)
      : mesh_(mesh),
        couplings_(couplings),
        nodes_{.positions = mesh.positions,
               .references = std::vector<int>(mesh.n_nodes(), -1),
               .names_followed = std::vector<std::string>(mesh.n_nodes()),
               .reference_names = {}},
        coupling_(mesh.n_nodes(), -1)
  {}

  /// Of all couplings, before any of them is followed.
  void add_reference_nodes();
  void add(int index);
  CoupledNodes follow_chains() &&;

 private:
  void check(const Coupling& coupling) const;
  void check_held() const;
  bool is_coupling(const std::string& name) const
  {
    return std::ranges::find(couplings_, name, &Coupling::name) != couplings_.end();
  }
  void follow_one_node(int index);
  void add_link(int index);
  void follow(int node, int parent, int index);

  const mesh::Mesh& mesh_;
  std::span<const Coupling> couplings_;
  CoupledNodes nodes_;
  std::vector<int> coupling_;  ///< of each node that follows another one
};

void Following::check(const Coupling& coupling) const
{
  for (const std::string& group : {coupling.group, coupling.to}) {
    if (group.empty() || (group == coupling.to && is_coupling(group))) continue;
    if (mesh::find_group(mesh_, group).nodes.empty())
      throw Error(fmt::format("{}: group \"{}\" has no nodes", describe(coupling), group));
  }
  if (!coupling.has_reference_node()) return;
  const bool used =
      std::ranges::find(mesh_.groups, coupling.name, &mesh::Group::name) != mesh_.groups.end();
  if (used || nodes_.reference_node(coupling.name)) {
    throw Error(
        fmt::format("coupling \"{}\": this name is already used; choose another", coupling.name));
  }
}

void Following::add_reference_nodes()
{
  for (const Coupling& coupling : couplings_) {
    check(coupling);
    if (!coupling.has_reference_node()) continue;
    const mesh::Group& group = mesh::find_group(mesh_, coupling.group);
    nodes_.positions.push_back(coupling.at ? *coupling.at : centre(mesh_, group));
    nodes_.references.push_back(-1);
    nodes_.names_followed.emplace_back();
    nodes_.reference_names.push_back(coupling.name);
  }
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
  nodes_.references[node] = parent;
  nodes_.names_followed[node] = coupling.has_reference_node() ? coupling.name : coupling.to;
}

void Following::follow_one_node(int index)
{
  const Coupling& coupling = couplings_[index];
  const std::vector<int> leaders = nodes_.named_nodes(mesh_, coupling.to);
  if (leaders.size() != 1) {
    throw Error(fmt::format("{}: \"{}\" has {} nodes; a rigid body follows one, or a coupling",
                            describe(coupling), coupling.to, leaders.size()));
  }
  for (const int node : mesh::find_group(mesh_, coupling.group).nodes) {
    if (node == leaders.front()) {
      throw Error(fmt::format("{}: node {} belongs to both groups", describe(coupling),
                              mesh_.node_numbers[node]));
    }
    follow(node, leaders.front(), index);
  }
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
  if (coupling.kind == CouplingKind::link) return add_link(index);
  if (!coupling.has_reference_node()) return follow_one_node(index);
  if (coupling.kind == CouplingKind::averaging) return;
  for (const int node : mesh::find_group(mesh_, coupling.group).nodes)
    follow(node, nodes_.reference_node(coupling.name).value(), index);
}

/// Nothing gives stiffness to a reference node that nodes of no element alone follow.
void Following::check_held() const
{
  std::vector<bool> is_held(std::size_t(nodes_.n_nodes()), false);
  for (const mesh::ElementBlock& block : mesh_.blocks)
    for (const int node : block.nodes)
      if (nodes_.is_dependent(node)) is_held[std::size_t(nodes_.reference(node))] = true;
  for (const Coupling& coupling : couplings_) {
    if (coupling.kind != CouplingKind::rigid || !coupling.has_reference_node()) continue;
    if (is_held[std::size_t(nodes_.reference_node(coupling.name).value())]) continue;
    throw Error(fmt::format("{}: no node of \"{}\" belongs to an element", describe(coupling),
                            coupling.group));
  }
}

/// A rigid body on a rigid body is one on the last of the chain.
CoupledNodes Following::follow_chains() &&
{
  const std::vector<int> parent = nodes_.references;
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
    nodes_.references[node] = end;
  }
  check_held();
  return std::move(nodes_);
}

}  // namespace

std::optional<int> CoupledNodes::reference_node(const std::string& name) const
{
  const auto it = std::ranges::find(reference_names, name);
  if (it == reference_names.end()) return std::nullopt;
  return n_mesh_nodes() + static_cast<int>(it - reference_names.begin());
}

std::vector<int> CoupledNodes::named_nodes(const mesh::Mesh& mesh, const std::string& name) const
{
  if (const auto reference = reference_node(name)) return {*reference};
  const auto group = std::ranges::find(mesh.groups, name, &mesh::Group::name);
  if (group != mesh.groups.end()) return group->nodes;
  std::vector<std::string> names = reference_names;
  for (const mesh::Group& g : mesh.groups) names.push_back(g.name);
  throw Error(
      fmt::format("\"{}\" is neither a group or ring of the mesh nor a coupling; there are: {}",
                  name, fmt::join(names, ", ")));
}

std::string describe(const Coupling& coupling)
{
  return coupling.has_reference_node()
             ? fmt::format("coupling \"{}\"", coupling.name)
             : fmt::format("link of \"{}\" to \"{}\"", coupling.group, coupling.to);
}

CoupledNodes follow_references(const mesh::Mesh& mesh, std::span<const Coupling> couplings)
{
  Following following(mesh, couplings);
  following.add_reference_nodes();
  for (int i = 0; i < std::ssize(couplings); ++i) following.add(i);
  return std::move(following).follow_chains();
}

}  // namespace chladni::plate
