#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Four places in the lattice of an element. A triangle repeats its last place, a line its last
/// place twice.
using LatticeCell = std::array<int, 4>;

/// The cells that an element of the block is drawn by.
/// @param step  width of a cell in lattice intervals: the order of the block gives one cell with
///              the corners of the element, 1 gives all cells of its lattice
std::vector<LatticeCell> lattice_cells(const ElementBlock& block, int step);

/// The nodes of each edge of an element, in order from end to end.
std::vector<std::vector<int>> edges_of(const ElementBlock& block, int element);

/// The element edges with all their nodes in the group. An edge between two elements is returned
/// once.
std::vector<std::vector<int>> edges_in(const Mesh& mesh, const Group& group);

/// The lattice places of the nodes in the order of VTK: corners, edges, inner nodes. Up to order 2
/// most other formats have the same order.
/// @param order  1 to 4
std::vector<int> corners_first(Shape shape, int order);

}  // namespace chladni::mesh
