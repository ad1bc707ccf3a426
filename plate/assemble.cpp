#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "plate/directors.hpp"
#include "plate/point_elements.hpp"
#include "plate/section_map.hpp"

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

/// Entries of each scalar row, in diagonal and off-diagonal block.
struct Preallocation {
  std::vector<PetscInt> diagonal, off_diagonal;
};

/// Active numbers of the neighbours of each node that this rank owns.
class Neighbours {
 public:
  Neighbours(const DofMap& dofs, int rank)
      : dofs_(dofs), first_(dofs.range[rank]), lists_(dofs.range[rank + 1] - first_)
  {}

  /// All nodes of an element are neighbours.
  void connect(std::span<const int> nodes)
  {
    const std::vector<PetscInt> numbers = active_numbers(dofs_, nodes);
    for (const PetscInt row : numbers) {
      if (row < first_ || row >= first_ + std::ssize(lists_)) continue;
      auto& list = lists_[row - first_];
      list.insert(list.end(), numbers.begin(), numbers.end());
    }
  }

  Preallocation preallocation()
  {
    const int n_c = dofs_.n_components();
    const auto last = first_ + std::ssize(lists_);
    Preallocation rows;
    for (auto& list : lists_) {
      std::ranges::sort(list);
      list.erase(std::unique(list.begin(), list.end()), list.end());
      const auto own = std::ranges::count_if(list, [&](int c) { return c >= first_ && c < last; });
      rows.diagonal.insert(rows.diagonal.end(), n_c, PetscInt(n_c * own));
      rows.off_diagonal.insert(rows.off_diagonal.end(), n_c,
                               PetscInt(n_c * (std::ssize(list) - own)));
    }
    return rows;
  }

 private:
  const DofMap& dofs_;
  PetscInt first_;
  std::vector<std::vector<PetscInt>> lists_;
};

Preallocation preallocation(const mesh::Mesh& mesh, std::span<const PointElement> points,
                            const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    neighbours.connect(block.element_nodes(e));
  });
  for (const PointElement& point : points) neighbours.connect(point.nodes);
  return neighbours.preallocation();
}

/// Of C alone, whose few entries are those of the dampers.
Preallocation preallocation(std::span<const PointElement> points, const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  for (const PointElement& point : points) {
    if (point.C.size() > 0) neighbours.connect(point.nodes);
  }
  return neighbours.preallocation();
}

petsc::Matrix empty_matrix(const Preallocation& rows, int block_size, MPI_Comm comm)
{
  const auto n_rows = static_cast<PetscInt>(rows.diagonal.size());
  petsc::Matrix A;
  petsc::check(MatCreate(comm, A.put()));
  petsc::check(MatSetSizes(A, n_rows, n_rows, PETSC_DETERMINE, PETSC_DETERMINE));
  petsc::check(MatSetType(A, MATAIJ));
  petsc::check(MatSetBlockSize(A, block_size));
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

/// Rows and columns of the components that the system has.
MatrixXd only_components(MatrixXd A_e, const DofMap& dofs)
{
  if (dofs.n_components() == 6) return A_e;
  std::vector<Index> kept;
  for (Index node = 0; node < A_e.rows(); node += 6) {
    for (const int c : dofs.components) kept.push_back(node + c);
  }
  return A_e(kept, kept);
}

/// Adds element matrices of 6 DOFs for each node: those rows that this rank owns.
class Inserter {
 public:
  Inserter(const DofMap& dofs, int rank) : dofs_(dofs), rank_(rank) {}

  void add(Mat A, const MatrixXd& A_e, std::span<const int> nodes) const
  {
    const std::vector<PetscInt> columns = active_numbers(dofs_, nodes);
    std::vector<PetscInt> rows = columns;
    for (PetscInt& row : rows) {
      if (row < dofs_.range[rank_] || row >= dofs_.range[rank_ + 1]) row = -1;  // PETSc skips it
    }
    const MatrixXd in_system = only_components(eliminate_dependents(A_e, dofs_, nodes), dofs_);
    const auto n = static_cast<PetscInt>(columns.size());
    // A_e is symmetric: its column-major storage is the row-major one that PETSc reads.
    petsc::check(
        MatSetValuesBlocked(A, n, rows.data(), n, columns.data(), in_system.data(), ADD_VALUES));
  }

 private:
  const DofMap& dofs_;
  int rank_;
};

void add_points(const System& system, std::span<const PointElement> points,
                const Inserter& inserter)
{
  for (const PointElement& point : points) {
    if (point.K.size() > 0) inserter.add(system.K, point.K, point.nodes);
    if (point.M.size() > 0) inserter.add(system.M, point.M, point.nodes);
    if (point.C.size() > 0) inserter.add(system.C, point.C, point.nodes);
  }
}

System empty_system(const mesh::Mesh& mesh, std::span<const PointElement> points,
                    const DofMap& dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  const int block_size = dofs.n_components();
  const Preallocation rows = preallocation(mesh, points, dofs, rank);
  System system{.K = empty_matrix(rows, block_size, comm),
                .M = empty_matrix(rows, block_size, comm),
                .C = {},
                .dofs = {}};
  const auto is_damper = [](const PointElement& point) { return point.C.size() > 0; };
  if (std::ranges::any_of(points, is_damper)) {
    system.C = empty_matrix(preallocation(points, dofs, rank), block_size, comm);
  }
  return system;
}

}  // namespace

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  const SectionMap sections = map_sections(mesh, structure);
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const NodeVectors normals = mean_normals(mesh);
  System system = empty_system(mesh, points, dofs, comm);
  const Inserter inserter(dofs, rank);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e) {
    const ElementMatrices matrices =
        element_matrices(mesh, block, e, {sections, structure, normals});
    inserter.add(system.K, matrices.K, block.element_nodes(e));
    inserter.add(system.M, matrices.M, block.element_nodes(e));
  });
  add_points(system, points, inserter);
  for (const Mat A : {Mat(system.K), Mat(system.M), Mat(system.C)}) {
    if (A == nullptr) continue;
    petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  system.dofs = std::move(dofs);
  return system;
}

System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm)
{
  return assemble(mesh, Structure{.shells = sections}, std::move(dofs), comm);
}

}  // namespace chladni::plate
