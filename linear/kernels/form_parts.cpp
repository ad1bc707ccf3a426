#include "linear/kernels/form_parts.hpp"

#include <algorithm>
#include <utility>

#include "common/index_sets.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/own_submatrix.hpp"

namespace chladni::linear {

namespace {

/// The columns of X that are not zero in some rows, the same on every rank.
std::vector<PetscInt> columns_in(const LocalRows& X, const std::vector<PetscInt>& rows,
                                 MPI_Comm comm)
{
  std::vector<int> is_there(X.n_cols(), 0);
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    is_there[j] = std::ranges::any_of(rows, [&](PetscInt i) { return X(i, j) != 0.0; }) ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, is_there.data(), static_cast<int>(is_there.size()), MPI_INT, MPI_MAX,
                comm);
  std::vector<PetscInt> columns;
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    if (is_there[j] != 0) columns.push_back(j);
  return columns;
}

/// Sets of rows of this rank in which A has entries other than zero.
std::vector<std::vector<PetscInt>> sets_with_entries(const std::vector<petsc::IndexSet>& sets,
                                                     Mat A)
{
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  std::vector<char> has_entries(std::size_t(end - begin), 0);
  for_local_entries(A, [&](PetscInt row, PetscInt /*column*/, double value) {
    if (value != 0.0) has_entries[row - begin] = 1;
  });
  std::vector<std::vector<PetscInt>> rows(sets.size());
  std::vector<int> is_there(sets.size(), 0);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    rows[k] = petsc::own_rows(sets[k], A);
    if (std::ranges::any_of(rows[k], [&](PetscInt i) { return has_entries[i] != 0; }))
      is_there[k] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, is_there.data(), static_cast<int>(is_there.size()), MPI_INT, MPI_MAX,
                petsc::communicator(A));
  std::vector<std::vector<PetscInt>> some;
  for (std::size_t k = 0; k < sets.size(); ++k)
    if (is_there[k] != 0) some.push_back(std::move(rows[k]));
  return some;
}

}  // namespace

std::vector<FormPart> form_parts(Mat A, std::span<const Mat> X)
{
  std::vector<FormPart> parts;
  for (std::vector<PetscInt>& rows : sets_with_entries(decoupled_rows(A, A), A)) {
    FormPart part{.rows = std::move(rows), .columns = {}};
    for (const Mat all : X)
      part.columns.push_back(columns_in(LocalRows(all), part.rows, petsc::communicator(A)));
    const auto alike = std::ranges::find(parts, part.columns, &FormPart::columns);
    if (alike == parts.end())
      parts.push_back(std::move(part));
    else
      alike->rows.insert(alike->rows.end(), part.rows.begin(), part.rows.end());
  }
  for (FormPart& part : parts) std::ranges::sort(part.rows);
  return parts;
}

petsc::Matrix matrix_of(const FormPart& part, Mat A)
{
  PetscInt begin = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, nullptr));
  std::vector<PetscInt> global = part.rows;
  for (PetscInt& row : global) row += begin;
  petsc::IndexSet rows;
  petsc::check(ISCreateGeneral(petsc::communicator(A), static_cast<PetscInt>(global.size()),
                               global.data(), PETSC_USE_POINTER, rows.put()));
  return own_submatrix(A, rows, rows);
}

}  // namespace chladni::linear
