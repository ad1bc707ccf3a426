#include "plate/dofs/number_nodes.hpp"

#include <algorithm>

namespace chladni::plate {

namespace {

constexpr int nowhere = -1;

/// The rank that numbers each node. A reference node goes to the lowest rank among its dependents,
/// that of an averaging coupling nowhere, since its DOFs stand at its group.
std::vector<int> numbering_ranks(const CoupledNodes& nodes, std::span<const Coupling> couplings,
                                 std::span<const int> owners, int n_ranks)
{
  std::vector<int> ranks(owners.begin(), owners.end());
  ranks.resize(nodes.n_nodes(), n_ranks - 1);
  for (int node = 0; node < nodes.n_mesh_nodes(); ++node) {
    const int reference = nodes.reference(node);
    if (reference < 0) continue;
    ranks[node] = nowhere;
    if (reference < nodes.n_mesh_nodes()) continue;
    ranks[reference] = std::min(ranks[reference], owners[node]);
  }
  for (const Coupling& coupling : couplings) {
    if (coupling.kind != CouplingKind::averaging) continue;
    ranks[nodes.reference_node(coupling.name).value()] = nowhere;
  }
  return ranks;
}

}  // namespace

NumberedNodes number_nodes(CoupledNodes coupled, std::span<const Coupling> couplings,
                           std::span<const int> owners, int n_ranks)
{
  const std::vector<int> ranks = numbering_ranks(coupled, couplings, owners, n_ranks);
  NumberedNodes nodes{std::move(coupled), std::vector<int>(ranks.size(), -1), {}};
  int next = 0;
  for (int rank = 0; rank < n_ranks; ++rank) {
    nodes.first_numbers.push_back(next);
    for (std::size_t node = 0; node < ranks.size(); ++node)
      if (ranks[node] == rank) nodes.numbers[node] = next++;
  }
  nodes.first_numbers.push_back(next);
  return nodes;
}

}  // namespace chladni::plate
