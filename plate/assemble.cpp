#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "plate/directors.hpp"
#include "plate/sections.hpp"
#include "plate/shell_element.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The active numbers on which the motion of some nodes depends, ascending.
std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) {
    if (dofs.is_plain(node)) {
      numbers.push_back(dofs.number[node]);
      continue;
    }
    for (const MotionTerm& term : dofs.motion(node)) numbers.push_back(term.number);
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Calls visit(block, element, its active numbers) for each element that depends on a number that
/// this rank owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<PetscInt> numbers = active_numbers(dofs, block.element_nodes(e));
      const auto owned = std::ranges::lower_bound(numbers, first);
      if (owned != numbers.end() && *owned < last) visit(block, e, numbers);
    }
  }
}

/// Numbers of the neighbours of each owned node, in diagonal and off-diagonal block of the row.
struct Preallocation {
  std::vector<PetscInt> diagonal, off_diagonal;  ///< entries of each scalar row
};

Preallocation preallocation(const mesh::Mesh& mesh, const DofMap& dofs, int rank)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  std::vector<std::vector<PetscInt>> neighbours(last - first);
  for_owned_elements(mesh, dofs, rank, [&](const auto&, int, const auto& numbers) {
    for (const PetscInt row : numbers) {
      if (row < first || row >= last) continue;
      auto& list = neighbours[row - first];
      list.insert(list.end(), numbers.begin(), numbers.end());
    }
  });
  Preallocation rows;
  for (auto& list : neighbours) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    const auto own = std::ranges::count_if(list, [&](int c) { return c >= first && c < last; });
    rows.diagonal.insert(rows.diagonal.end(), 6, PetscInt(6 * own));
    rows.off_diagonal.insert(rows.off_diagonal.end(), 6, PetscInt(6 * (std::ssize(list) - own)));
  }
  return rows;
}

petsc::Matrix empty_matrix(const Preallocation& rows, MPI_Comm comm)
{
  const auto n_rows = static_cast<PetscInt>(rows.diagonal.size());
  petsc::Matrix A;
  petsc::check(MatCreate(comm, A.put()));
  petsc::check(MatSetSizes(A, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE));
  petsc::check(MatSetType(A, MATAIJ));
  petsc::check(MatSetBlockSize(A, 6));
  petsc::check(MatSeqAIJSetPreallocation(A, 0, rows.diagonal.data()));
  petsc::check(MatMPIAIJSetPreallocation(A, 0, rows.diagonal.data(), 0, rows.off_diagonal.data()));
  petsc::check(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  petsc::check(MatSetOption(A, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  return A;
}

/// T_e of the motion u_e = T_e q of the mid-surface at the nodes of an element, with q at
/// `numbers`: through the couplings to the nodes of the mesh, and over the offset from these to the
/// mid-surface.
MatrixXd element_motion(const DofMap& dofs, std::span<const int> nodes, const NodeVectors& x,
                        const std::vector<PetscInt>& numbers)
{
  MatrixXd T_e = MatrixXd::Zero(6 * std::ssize(nodes), 6 * std::ssize(numbers));
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    const auto [x_0, x_1, x_2] = dofs.positions[nodes[i]];
    const Matrix6d arm = rigid_arm(x.row(i).transpose() - Eigen::Vector3d(x_0, x_1, x_2));
    for (const MotionTerm& term : dofs.motion(nodes[i])) {
      const auto column = std::ranges::lower_bound(numbers, term.number) - numbers.begin();
      T_e.block<6, 6>(6 * i, 6 * column) += arm * term.T;
    }
  }
  return T_e;
}

/// Checked before the parallel work, on the whole mesh: every rank throws or none.
void check_sections(const mesh::Mesh& mesh, std::span<const ShellSection> sections,
                    const std::vector<int>& of_group)
{
  for (const mesh::ElementBlock& block : mesh.blocks) {
    check_element_exists(block.shape, block.order);
    for (int e = 0; e < block.n_elements(); ++e) section_of(sections, of_group, block, e);
  }
}

void insert(Mat A, const MatrixXd& A_e, const std::vector<PetscInt>& rows,
            const std::vector<PetscInt>& columns)
{
  const auto n = static_cast<PetscInt>(columns.size());
  // A_e is symmetric: its column-major storage is the row-major one that PETSc reads.
  petsc::check(MatSetValuesBlocked(A, n, rows.data(), n, columns.data(), A_e.data(), ADD_VALUES));
}

/// An element in the coordinates of the system.
struct ActiveElement {
  ElementMatrices matrices;
  std::vector<PetscInt> numbers;
};

ActiveElement active_element(const DofMap& dofs, std::span<const int> nodes,
                             const ShellNodes& shell, const ShellSection& section,
                             const mesh::ElementBlock& block)
{
  ElementMatrices matrices = shell_matrices(block.shape, block.order, shell, section.material);
  const bool plain = std::ranges::all_of(nodes, [&](int node) { return dofs.is_plain(node); });
  if (plain && section.offset == Profile(0.0)) {
    ActiveElement element{.matrices = std::move(matrices), .numbers = {}};
    for (const int node : nodes) element.numbers.push_back(dofs.number[node]);
    return element;
  }
  std::vector<PetscInt> numbers = active_numbers(dofs, nodes);
  const MatrixXd T_e = element_motion(dofs, nodes, shell.x, numbers);
  return {.matrices = {.K = T_e.transpose() * matrices.K * T_e,
                       .M = T_e.transpose() * matrices.M * T_e},
          .numbers = std::move(numbers)};
}

}  // namespace

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  const std::vector<int> of_group = section_of_group(mesh, sections);
  check_sections(mesh, sections, of_group);
  const NodeVectors normals = mean_normals(mesh);
  const Preallocation rows = preallocation(mesh, dofs, rank);
  System system{.K = empty_matrix(rows, comm), .M = empty_matrix(rows, comm), .dofs = {}};
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e, const auto&) {
    const ShellSection& section = section_of(sections, of_group, block, e);
    const auto [matrices, columns] =
        active_element(dofs, block.element_nodes(e), shell_nodes(mesh, block, e, normals, section),
                       section, block);
    std::vector<PetscInt> own = columns;
    for (PetscInt& row : own) {
      if (row < dofs.range[rank] || row >= dofs.range[rank + 1]) row = -1;  // PETSc skips it
    }
    insert(system.K, matrices.K, own, columns);
    insert(system.M, matrices.M, own, columns);
  });
  for (const Mat A : {Mat(system.K), Mat(system.M)}) {
    petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  system.dofs = std::move(dofs);
  return system;
}

}  // namespace chladni::plate
