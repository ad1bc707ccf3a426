#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// An entry of a matrix between DOFs 6 * node + component. Its nodes are in ascending order; in a
/// block of one node, so are the DOFs. The entry of the other triangle is the same.
struct MatrixEntry {
  int row, column;
  double value;  ///< N/m, N, N m of K; the same times s of C, times s^2 of M
};

/// The symmetric matrices of another program for the nodes of a mesh, ordered by the nodes of rows
/// and columns.
struct NodalMatrices {
  std::vector<std::int8_t> n_components;  ///< [n_nodes of the file] 0 (no DOFs), 3 or 6
  std::vector<MatrixEntry> K, M, C, H;    ///< C and H may be empty

  std::array<const std::vector<MatrixEntry>*, 4> all() const { return {&K, &M, &C, &H}; }
};

/// Calls visit(nodes, entries) for the block of each pair of nodes, or of one node, of a matrix.
template <typename Visit>
void for_blocks(const std::vector<MatrixEntry>& matrix, const Visit& visit)
{
  for (std::size_t begin = 0, end = 0; begin < matrix.size(); begin = end) {
    const std::array nodes{matrix[begin].row / 6, matrix[begin].column / 6};
    while (end < matrix.size() && matrix[end].row / 6 == nodes[0] &&
           matrix[end].column / 6 == nodes[1])
      ++end;
    visit(std::span(nodes).first(nodes[0] == nodes[1] ? 1 : 2),
          std::span(matrix).subspan(begin, end - begin));
  }
}

/// Calls visit(nodes) for nodes that stiffness connects: those of an element, or of a block of the
/// matrices of the mesh.
template <typename Visit>
void for_connected_nodes(const Mesh& mesh, const Visit& visit)
{
  if (mesh.matrices) {
    for (const auto* matrix : mesh.matrices->all())
      for_blocks(*matrix, [&](std::span<const int> nodes, auto) { visit(nodes); });
    return;
  }
  for (const ElementBlock& block : mesh.blocks)
    for (int e = 0; e < block.n_elements(); ++e) visit(block.element_nodes(e));
}

/// Whether the mass of the matrices is one of points that all directions move alike: each block of
/// two nodes is m_ij I. The integrals over the mass then follow from M and the positions.
bool is_mass_of_points(const NodalMatrices& matrices);

/// Reads the matrices that `options.matrices` names, for the nodes of a mesh in metres. Nodes that
/// they do not know, no element has and no coupling needs are dropped from the mesh. Three checks
/// follow: M and K are symmetric with admissible diagonals, no row of K resists a rigid motion, and
/// M is the mass of a body. A note tells the mass, by which a unit can be seen to be right.
/// @throws chladni::Error naming file, line, node and DOF of what is wrong.
void add_matrices(Mesh& mesh, const MeshOptions& options);

}  // namespace chladni::mesh
