#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// The owner of each node after METIS has divided the elements among `n_parts` by the dual graph,
/// in which elements with a common edge are neighbours (a common node, if there are lines). A node
/// belongs to the lowest part among its elements.
/// @return [n_nodes] in 0 .. n_parts - 1; the same on every rank, since METIS is deterministic
/// @throws chladni::Error when there are fewer elements than parts.
std::vector<int> node_owners(const Mesh& mesh, int n_parts);

}  // namespace chladni::mesh
