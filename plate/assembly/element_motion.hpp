#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/nodal_matrices.hpp"
#include "plate/assembly/block_rows.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/point_elements.hpp"
#include "plate/elements/shell_strains.hpp"

/// The motion of elements as a function of the active DOFs, used by the assembly of every matrix.
namespace chladni::plate {

/// The active numbers on which the motion of some nodes depends, ascending.
std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes);

/// The motion u_e = T_e q of the points at which an element has its DOFs, with q at active numbers.
struct ElementMotion {
  std::vector<PetscInt> numbers;
  Eigen::MatrixXd T_e;  ///< [6 n_e x 6 n]; empty where u_e = q
};

/// The motion of an element: through the couplings to the nodes of the mesh, and along the arms
/// from these to the points.
/// @param arms  [n_e x 3] m; empty for zero
ElementMotion element_motion(const DofMap& dofs, std::span<const int> nodes,
                             const NodeVectors& arms);

/// Adds an element matrix with 6 DOFs for each node, transformed to the coordinates of the system.
/// @param A_e     symmetric, or the transpose of what is added
/// @param places  `block_places` of motion.numbers
void add(BlockRows& A, Eigen::MatrixXd A_e, const ElementMotion& motion, const DofMap& dofs,
         std::span<const std::ptrdiff_t> places);

/// Adds a symmetric element matrix as `add`. The mean of both sides of the diagonal is added, so
/// that the sums are symmetric to the last bit and an entry that cancels does so on both sides.
void add_symmetric(BlockRows& A, Eigen::MatrixXd A_e, const ElementMotion& motion,
                   const DofMap& dofs, std::span<const std::ptrdiff_t> places);

/// Whether an element with these nodes may depend on a number from `first` to before `last`.
bool may_depend_on(const DofMap& dofs, std::span<const int> nodes, int first, int last);

/// Calls visit(nodes, entries) for each block of a matrix of the mesh that depends on a number that
/// this rank owns.
template <typename Visit>
void for_owned_blocks(const std::vector<mesh::MatrixEntry>& matrix, const DofMap& dofs, int rank,
                      const Visit& visit)
{
  const int first = dofs.first_number(rank), last = dofs.first_number(rank + 1);
  mesh::for_blocks(matrix, [&](std::span<const int> nodes, auto entries) {
    if (may_depend_on(dofs, nodes, first, last)) visit(nodes, entries);
  });
}

/// A block of a matrix of the mesh as that of an element.
/// @return [6 n x 6 n] with its one or two nodes, symmetric
Eigen::MatrixXd block_matrix(std::span<const int> nodes,
                             std::span<const mesh::MatrixEntry> entries);

/// The pattern of a rank. All active numbers of an element are neighbours, and so are those of a
/// block of the matrices of the mesh and of a point element.
BlockPattern element_pattern(const mesh::Mesh& mesh, std::span<const PointElement> points,
                             const DofMap& dofs, int rank);
/// The pattern of a rank with the point elements alone.
BlockPattern point_pattern(std::span<const PointElement> points, const DofMap& dofs, int rank);

/// Calls visit(block, element, its active numbers) for each element that depends on a number that
/// this rank owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.first_number(rank);
  const int last = dofs.first_number(rank + 1);
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (!may_depend_on(dofs, block.element_nodes(e), first, last)) continue;
      const std::vector<PetscInt> numbers = active_numbers(dofs, block.element_nodes(e));
      const auto owned = std::ranges::lower_bound(numbers, first);
      if (owned != numbers.end() && *owned < last) visit(block, e, numbers);
    }
  }
}

}  // namespace chladni::plate
