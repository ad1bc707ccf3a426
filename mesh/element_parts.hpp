#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Four places of an element's lattice; a triangle repeats its last one, a line twice.
using LatticeCell = std::array<int, 4>;

/// The cells that an element of the block is drawn by, each `step` lattice intervals wide: the
/// order of the block for one cell of its corners, 1 for all cells of its lattice.
std::vector<LatticeCell> lattice_cells(const ElementBlock& block, int step);

/// The nodes of an element's edges, each edge from end to end.
std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element);

/// Element edges with all their nodes in the group; an edge between two elements counts once.
std::vector<std::vector<int>> edges_in(const Mesh& mesh, const Group& group);

/// The lattice places of an element's nodes in the order of VTK, up to order 2 also that of most
/// other formats: corners, then edges, then the inner nodes.
/// @param order  up to 4
std::vector<int> corners_first(Shape shape, int order);

}  // namespace chladni::mesh
