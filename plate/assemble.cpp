#include "plate/assemble.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "common/error.hpp"
#include "plate/directors.hpp"
#include "plate/point_elements.hpp"
#include "plate/section_map.hpp"

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

  /// All active numbers of an element are neighbours.
  void connect(const std::vector<PetscInt>& numbers)
  {
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
  for_owned_elements(mesh, dofs, rank,
                     [&](const auto&, int, const auto& numbers) { neighbours.connect(numbers); });
  for (const PointElement& point : points) neighbours.connect(active_numbers(dofs, point.nodes));
  return neighbours.preallocation();
}

/// Of C alone, whose few entries are those of the dampers.
Preallocation preallocation(std::span<const PointElement> points, const DofMap& dofs, int rank)
{
  Neighbours neighbours(dofs, rank);
  for (const PointElement& point : points) {
    if (point.C.size() > 0) neighbours.connect(active_numbers(dofs, point.nodes));
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

/// u_e = T_e q of the points where the DOFs of an element stand, with q at active numbers.
struct ElementMotion {
  std::vector<PetscInt> numbers;
  MatrixXd T_e;  ///< [6 n_e x 6 n]; empty where u_e = q
};

/// Through the couplings to the nodes of the mesh, and along the arms from these to the points.
/// @param arms  [n_e x 3] m; empty for zero
ElementMotion element_motion(const DofMap& dofs, std::span<const int> nodes,
                             const NodeVectors& arms)
{
  const bool plain = std::ranges::all_of(nodes, [&](int node) { return dofs.is_plain(node); });
  ElementMotion motion;
  if (plain && arms.size() == 0) {
    for (const int node : nodes) motion.numbers.push_back(dofs.number[node]);
    return motion;
  }
  motion.numbers = active_numbers(dofs, nodes);
  motion.T_e = MatrixXd::Zero(6 * std::ssize(nodes), 6 * std::ssize(motion.numbers));
  for (Index i = 0; i < std::ssize(nodes); ++i) {
    Matrix6d arm = Matrix6d::Identity();
    if (arms.size() > 0) arm = rigid_arm(arms.row(i));
    for (const MotionTerm& term : dofs.motion(nodes[i])) {
      const auto column =
          std::ranges::lower_bound(motion.numbers, term.number) - motion.numbers.begin();
      motion.T_e.block<6, 6>(6 * i, 6 * column) += arm * term.T;
    }
  }
  return motion;
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

/// Adds element matrices of 6 DOFs for each node in the coordinates of the system: those rows that
/// this rank owns.
class Inserter {
 public:
  Inserter(const DofMap& dofs, int rank) : dofs_(dofs), rank_(rank) {}

  void add(Mat A, const MatrixXd& A_e, const ElementMotion& motion) const
  {
    std::vector<PetscInt> rows = motion.numbers;
    for (PetscInt& row : rows) {
      if (row < dofs_.range[rank_] || row >= dofs_.range[rank_ + 1]) row = -1;  // PETSc skips it
    }
    const MatrixXd& T_e = motion.T_e;
    const MatrixXd in_system =
        only_components(T_e.size() == 0 ? A_e : MatrixXd(T_e.transpose() * A_e * T_e), dofs_);
    const auto n = static_cast<PetscInt>(rows.size());
    // A_e is symmetric: its column-major storage is the row-major one that PETSc reads.
    petsc::check(MatSetValuesBlocked(A, n, rows.data(), n, motion.numbers.data(), in_system.data(),
                                     ADD_VALUES));
  }

 private:
  const DofMap& dofs_;
  int rank_;
};

void add_points(const System& system, std::span<const PointElement> points, const DofMap& dofs,
                const Inserter& inserter)
{
  for (const PointElement& point : points) {
    const ElementMotion motion = element_motion(dofs, point.nodes, {});
    if (point.K.size() > 0) inserter.add(system.K, point.K, motion);
    if (point.M.size() > 0) inserter.add(system.M, point.M, motion);
    if (point.C.size() > 0) inserter.add(system.C, point.C, motion);
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

/// The DOFs of an average stand in those of its group, whatever component these are.
void check_components(const DofMap& dofs)
{
  if (dofs.n_components() == 6 || dofs.combined_motions.empty()) return;
  throw Error(
      "an averaging coupling needs all six DOFs of each node; use a rigid one, or all six DOFs");
}

}  // namespace

System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm)
{
  const int rank = petsc::rank(comm);
  check_components(dofs);
  const SectionMap sections = map_sections(mesh, structure);
  const std::vector<PointElement> points = point_elements(mesh, structure, dofs);
  const NodeVectors normals = mean_normals(mesh);
  System system = empty_system(mesh, points, dofs, comm);
  const Inserter inserter(dofs, rank);
  for_owned_elements(mesh, dofs, rank, [&](const mesh::ElementBlock& block, int e, const auto&) {
    const auto [matrices, arms] = element_matrices(mesh, block, e, {sections, structure, normals});
    const ElementMotion motion = element_motion(dofs, block.element_nodes(e), arms);
    inserter.add(system.K, matrices.K, motion);
    inserter.add(system.M, matrices.M, motion);
  });
  add_points(system, points, dofs, inserter);
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
