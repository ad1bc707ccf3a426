#include "reduce/plugin/check_operators.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "reduce/dense.hpp"

namespace chladni::reduce::plugin {

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
  agree(petsc::communicator(A), complaint);
  PetscBool assembled = PETSC_FALSE;
  petsc::check(MatAssembled(A, &assembled));
  if (!assembled) {
    throw Error(
        fmt::format("CMSSetOperators: {} is not assembled; call MatAssemblyBegin() and "
                    "MatAssemblyEnd()",
                    name));
  }
}

petsc::Matrix as_aij(Mat A)
{
  PetscBool aij = PETSC_FALSE;
  petsc::check(PetscObjectBaseTypeCompareAny(reinterpret_cast<PetscObject>(A), &aij, MATSEQAIJ,
                                             MATMPIAIJ, ""));
  petsc::Matrix result;
  if (aij) {
    petsc::check(PetscObjectReference(reinterpret_cast<PetscObject>(A)));
    return petsc::Matrix(A);
  }
  petsc::check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, result.put()));
  return result;
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
  for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    result.row_sums[row - first] += std::abs(value);
    if (result.complaint) return;
    if (!std::isfinite(value)) {
      result.complaint = fmt::format(
          "CMSSetOperators: {}[{}, {}] = {} is not finite; look at what "
          "assembled it",
          name, row, column, value);
    } else if (row == column && value < 0.0) {
      result.complaint = fmt::format(
          "CMSSetOperators: {}[{}, {}] = {:g} is negative, so {} is "
          "indefinite; K and M must be positive semidefinite",
          name, row, column, value, name);
    }
  });
  return result;
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

void agree(MPI_Comm comm, const std::optional<std::string>& complaint)
{
  const int none = petsc::size(comm);
  int speaker = complaint ? petsc::rank(comm) : none;
  MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, comm);
  if (speaker == none) return;
  std::string text = complaint.value_or("");
  auto size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, speaker, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, speaker, comm);
  throw Error(text);
}

petsc::Matrix checked_operator(Mat A, Mat like, const char* name)
{
  check_layout(A, like, name);
  petsc::Matrix aij = as_aij(A);
  const Scan entries = scan(aij, name);
  agree(petsc::communicator(A), entries.complaint);
  agree(petsc::communicator(A), find_asymmetry(aij, entries.row_sums, name));
  return aij;
}

}  // namespace chladni::reduce::plugin
