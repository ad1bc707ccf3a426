#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "plate/directors.hpp"
#include "plate/sections.hpp"
#include "plate/shell_element.hpp"

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Calls visit(block, element) for each element with a node that `first <= number < last` owns.
template <typename Visit>
void for_owned_elements(const mesh::Mesh& mesh, const DofMap& dofs, int rank, const Visit& visit)
{
  const int first = dofs.range[rank];
  const int last = dofs.range[rank + 1];
  const auto owned = [&](int node) {
    return dofs.number[node] >= first && dofs.number[node] < last;
  };
  for (const mesh::ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (std::ranges::any_of(block.element_nodes(e), owned)) visit(block, e);
    }
  }
}

std::vector<PetscInt> active_numbers(const DofMap& dofs, std::span<const int> nodes)
{
  std::vector<PetscInt> numbers;
  for (const int node : nodes) numbers.push_back(dofs.number[node]);
  return numbers;
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
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    const std::vector<PetscInt> numbers = active_numbers(dofs, block.element_nodes(e));
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

/// A_e <- T_e^T A_e T_e with u = u_ref + theta_ref x arm, theta = theta_ref of dependent nodes.
MatrixXd eliminate_dependents(MatrixXd A_e, const DofMap& dofs, std::span<const int> nodes)
{
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!dofs.is_dependent(nodes[i])) continue;
    const auto [x, y, z] = dofs.arm(nodes[i]);
    Eigen::Matrix3d R;  // theta x arm = R theta
    R << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;
    const auto u = static_cast<Index>(6 * i);
    A_e.middleCols<3>(u + 3) += A_e.middleCols<3>(u) * R;
    A_e.middleRows<3>(u + 3) += R.transpose() * A_e.middleRows<3>(u);
  }
  return A_e;
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
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    const ShellSection& section = section_of(sections, of_group, block, e);
    const ElementMatrices matrices =
        shell_matrices(block.shape, block.order,
                       shell_nodes(mesh, block, e, normals, section.thickness), section.material);
    const std::span<const int> nodes = block.element_nodes(e);
    const std::vector<PetscInt> columns = active_numbers(dofs, nodes);
    std::vector<PetscInt> own = columns;
    for (PetscInt& row : own) {
      if (row < dofs.range[rank] || row >= dofs.range[rank + 1]) row = -1;  // PETSc skips it
    }
    insert(system.K, eliminate_dependents(matrices.K, dofs, nodes), own, columns);
    insert(system.M, eliminate_dependents(matrices.M, dofs, nodes), own, columns);
  });
  for (const Mat A : {Mat(system.K), Mat(system.M)}) {
    petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  system.dofs = std::move(dofs);
  return system;
}

}  // namespace chladni::plate
