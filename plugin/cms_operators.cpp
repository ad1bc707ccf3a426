#include "plugin/cms_operators.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"

namespace chladni::plugin {

namespace {

constexpr double asymmetry = 1e-8;  // of the sum of a row's absolute values: no round-off

void check_layout(Mat A, Mat like, const char* name)
{
  PetscInt n_rows = 0, n_columns = 0, n = 0, n_local = 0, m_local = 0, n_like = 0;
  petsc::check(MatGetSize(A, &n_rows, &n_columns));
  petsc::check(MatGetSize(like, &n, nullptr));
  if (n_rows != n_columns || n_rows != n) {
    throw Error(
        fmt::format("CMSSetOperators: {} is {} x {}, but K has {} rows; all operators are "
                    "square and of one size",
                    name, n_rows, n_columns, n));
  }
  petsc::check(MatGetLocalSize(A, &n_local, &m_local));
  petsc::check(MatGetLocalSize(like, &n_like, nullptr));
  std::optional<std::string> complaint;
  if (n_local != n_like || m_local != n_like) {
    complaint = fmt::format(
        "CMSSetOperators: a rank has {} rows and {} columns of {}, but {} rows "
        "of K; distribute all operators alike",
        n_local, m_local, name, n_like);
  }
  agree_on(complaint, petsc::communicator(A));
  PetscBool assembled = PETSC_FALSE;
  petsc::check(MatAssembled(A, &assembled));
  if (!assembled) {
    throw Error(
        fmt::format("CMSSetOperators: {} is not assembled; call MatAssemblyBegin() and "
                    "MatAssemblyEnd()",
                    name));
  }
}

/// Sums of absolute values of the own rows; complains of values without sense.
struct Scan {
  std::vector<double> row_sums;
  std::optional<std::string> complaint;
};

Scan scan(Mat A, const char* name)
{
  PetscInt first = 0, n_local = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  Scan result{.row_sums = std::vector<double>(n_local, 0.0), .complaint = {}};
  linear::for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    result.row_sums[row - first] += std::abs(value);
    if (result.complaint) return;
    if (!std::isfinite(value))
      result.complaint = fmt::format(
          "CMSSetOperators: {}[{}, {}] = {} is not finite; look at what "
          "assembled it",
          name, row, column, value);
    else if (row == column && value < 0.0)
      result.complaint = fmt::format(
          "CMSSetOperators: {}[{}, {}] = {:g} is negative, so {} is "
          "indefinite; K, M and damping must be positive semidefinite",
          name, row, column, value, name);
  });
  return result;
}

/// The diagonal on every rank.
std::vector<double> diagonal_everywhere(Mat A)
{
  petsc::Vector own, all;
  VecScatter scatter = nullptr;
  PetscInt n = 0;
  const PetscScalar* values = nullptr;
  petsc::check(MatCreateVecs(A, own.put(), nullptr));
  petsc::check(MatGetDiagonal(A, own));
  petsc::check(VecScatterCreateToAll(own, &scatter, all.put()));
  petsc::check(VecScatterBegin(scatter, own, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterEnd(scatter, own, all, INSERT_VALUES, SCATTER_FORWARD));
  petsc::check(VecScatterDestroy(&scatter));
  petsc::check(VecGetSize(all, &n));
  petsc::check(VecGetArrayRead(all, &values));
  std::vector<double> diagonal(values, values + n);
  petsc::check(VecRestoreArrayRead(all, &values));
  return diagonal;
}

/// A_ij^2 > A_ii A_jj, which no semidefinite matrix has.
std::optional<std::string> find_indefinite_minor(Mat A, const char* name)
{
  constexpr double round_off = 1e-8;
  const std::vector<double> diagonal = diagonal_everywhere(A);
  std::optional<std::string> complaint;
  linear::for_local_entries(A, [&](PetscInt i, PetscInt j, double value) {
    const double most = std::sqrt(diagonal[i]) * std::sqrt(diagonal[j]);
    if (complaint || i == j || std::abs(value) <= (1.0 + round_off) * most) return;
    complaint = fmt::format(
        "CMSSetOperators: {0}[{1}, {2}] = {3:g} is larger than the root of {0}[{1}, {1}] {0}[{2}, "
        "{2}] = {4:g}, so {0} is indefinite; K and M must be positive semidefinite",
        name, i, j, value, most);
  });
  return complaint;
}

/// Numbers in (-1, 1) that depend on the global row only.
petsc::Vector probe(Mat A)
{
  petsc::Vector x;
  PetscInt first = 0, last = 0;
  PetscScalar* values = nullptr;
  petsc::check(MatCreateVecs(A, x.put(), nullptr));
  petsc::check(VecGetOwnershipRange(x, &first, &last));
  petsc::check(VecGetArray(x, &values));
  for (PetscInt i = first; i < last; ++i) {
    std::uint64_t z = (static_cast<std::uint64_t>(i) + 1) * 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    values[i - first] = 2.0 * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1.0;
  }
  petsc::check(VecRestoreArray(x, &values));
  return x;
}

/// A x = A^T x for a random x, row by row.
std::optional<std::string> find_asymmetry(Mat A, const std::vector<double>& row_sums,
                                          const char* name)
{
  const petsc::Vector x = probe(A);
  petsc::Vector y, z;
  petsc::check(VecDuplicate(x, y.put()));
  petsc::check(VecDuplicate(x, z.put()));
  petsc::check(MatMult(A, x, y));
  petsc::check(MatMultTranspose(A, x, z));
  petsc::check(VecAXPY(y, -1.0, z));
  PetscInt first = 0;
  const PetscScalar* differences = nullptr;
  std::optional<std::string> complaint;
  petsc::check(VecGetOwnershipRange(y, &first, nullptr));
  petsc::check(VecGetArrayRead(y, &differences));
  for (std::size_t i = 0; i < row_sums.size() && !complaint; ++i) {
    if (std::abs(differences[i]) <= asymmetry * row_sums[i]) continue;
    complaint = fmt::format(
        "CMSSetOperators: {} is not symmetric: row and column {} differ by "
        "{:.1e} of the row's norm; boundary conditions by MatZeroRows() need "
        "MatZeroRowsColumns()",
        name, first + static_cast<PetscInt>(i), std::abs(differences[i]) / row_sums[i]);
  }
  petsc::check(VecRestoreArrayRead(y, &differences));
  return complaint;
}

}  // namespace

petsc::Matrix checked_operator(Mat A, Mat like, const char* name)
{
  check_layout(A, like, name);
  petsc::Matrix aij = linear::with_ascending_rows(linear::as_aij(A));
  const Scan entries = scan(aij, name);
  agree_on(entries.complaint, petsc::communicator(A));
  agree_on(find_asymmetry(aij, entries.row_sums, name), petsc::communicator(A));
  agree_on(find_indefinite_minor(aij, name), petsc::communicator(A));
  return aij;
}

VelocityForces checked_velocity_forces(Mat C, Mat like)
{
  check_layout(C, like, "C");
  petsc::Matrix aij = linear::with_ascending_rows(linear::as_aij(C));
  const Scan entries = scan(aij, "C");
  agree_on(entries.complaint, petsc::communicator(C));
  int skew = find_asymmetry(aij, entries.row_sums, "C") ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &skew, 1, MPI_INT, MPI_MAX, petsc::communicator(C));
  return {.C = std::move(aij), .is_symmetric = skew == 0};
}

void refuse_empty_rows(Mat K, Mat M, const std::vector<PetscInt>& masters,
                       const NameOfRow& name_of_row)
{
  const std::vector<double> stiffness = scan(K, "K").row_sums, mass = scan(M, "M").row_sums;
  PetscInt first = 0, n_empty = 0;
  petsc::check(MatGetOwnershipRange(K, &first, nullptr));
  std::optional<PetscInt> named;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const PetscInt row = first + static_cast<PetscInt>(i);
    const bool moves = std::ranges::binary_search(masters, row) && mass[i] > 0.0;
    if (stiffness[i] > 0.0 || moves) continue;
    if (!named) named = row;
    ++n_empty;
  }
  const MPI_Comm comm = petsc::communicator(K);
  MPI_Allreduce(MPI_IN_PLACE, &n_empty, 1, MPIU_INT, MPI_SUM, comm);
  std::optional<std::string> complaint;
  if (named) {
    complaint = fmt::format(
        "CMSSetUp: {} is empty (empty rows: {}): nothing resists this DOF, as the "
        "rotation about the normal of a flat shell (drilling); leave such rows out, or give them "
        "a stiffness on the diagonal",
        name_of_row ? name_of_row(*named) : fmt::format("row {} of K", *named), n_empty);
  }
  agree_on(complaint, comm);
}

namespace {

/// With the name of the function whose arguments are at fault.
void check_sectors(const cyclic::MatchingRows& rows, PetscInt order, PetscInt n_rows)
{
  try {
    cyclic::check_matching_rows(rows, n_rows);
  } catch (const Error& error) {
    throw Error(fmt::format("CMSSetCyclic: {}", error.what()));
  }
  if (order < 0 || order > rows.count / 2) {
    throw Error(
        fmt::format("CMSSetHarmonic: harmonic {} of {} sectors; give 0 to {}, -cms_harmonic", order,
                    rows.count, rows.count / 2));
  }
}

petsc::Matrix symmetric_operator(Mat A, const cyclic::SectorHarmonic& harmonic)
{
  petsc::Matrix form = cyclic::harmonic_operator(A, harmonic);
  petsc::check(MatSetOption(form, MAT_SYMMETRIC, PETSC_TRUE));
  return form;
}

}  // namespace

std::vector<PetscInt> all_indices(IS set)
{
  petsc::IndexSet gathered;
  petsc::check(ISAllGather(set, gathered.put()));
  return petsc::own_indices(gathered);
}

HarmonicProblem harmonic_problem(const Sectors& sectors, PetscInt order, const Operators& sector)
{
  cyclic::MatchingRows rows{.count = sectors.count,
                            .low = all_indices(sectors.low),
                            .high = all_indices(sectors.high),
                            .R = sectors.R};
  PetscInt n_rows = 0;
  petsc::check(MatGetSize(sector.K, &n_rows, nullptr));
  check_sectors(rows, order, n_rows);
  HarmonicProblem problem{
      .harmonic = cyclic::sector_harmonic(std::move(rows), static_cast<int>(order), sector.K),
      .operators = {}};
  problem.operators.K = symmetric_operator(sector.K, problem.harmonic);
  problem.operators.M = symmetric_operator(sector.M, problem.harmonic);
  problem.operators.velocity.is_symmetric = sector.velocity.is_symmetric;
  if (sector.velocity.C)
    problem.operators.velocity.C = cyclic::harmonic_operator(sector.velocity.C, problem.harmonic);
  return problem;
}

HarmonicMasters harmonic_masters(const cyclic::SectorCoordinates& coordinates,
                                 const std::vector<PetscInt>& masters)
{
  HarmonicMasters kept;
  for (const PetscInt row : masters) {
    if (const PetscInt low = coordinates.followed_by(row); low >= 0) {
      throw Error(fmt::format(
          "CMSSetInterface: master {} is in the high edge; give row {} of the low edge, "
          "which it follows",
          row, low));
    }
    for (const PetscInt other : coordinates.alike(row)) {
      if (std::ranges::find(masters, other) != masters.end()) continue;
      throw Error(fmt::format(
          "CMSSetInterface, CMSSetHeld: row {} is of a node that all sectors share, whose rows {} "
          "the rotation turns into each other; name all of them or none: row {} is missing",
          row, fmt::join(coordinates.alike(row), ", "), other));
    }
  }
  for (PetscInt phase = 0; phase < 2; ++phase) {
    for (std::size_t i = 0; i < masters.size(); ++i) {
      if (coordinates.n_of(masters[i]) <= phase) continue;
      kept.coordinates.push_back(coordinates.first(masters[i]) + phase);
      kept.rows.push_back(masters[i]);
      kept.phases.push_back(phase);
      kept.places.push_back(static_cast<PetscInt>(i));
    }
  }
  return kept;
}

}  // namespace chladni::plugin
