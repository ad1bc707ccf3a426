#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Owner of each node when the elements are divided among `n_parts` by METIS (dual graph, elements
/// that share an edge, or a node where there are lines, are neighbours): the lowest part among the
/// elements of the node.
/// @return [n_nodes] in 0..n_parts-1; the same on every rank since METIS is deterministic.
/// @throws chladni::Error when there are fewer elements than parts.
std::vector<int> node_owners(const Mesh& mesh, int n_parts);

}  // namespace chladni::mesh
