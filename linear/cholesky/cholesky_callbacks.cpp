#include "linear/cholesky/cholesky_callbacks.hpp"

#include <petsc/private/matimpl.h>

#include <algorithm>
#include <numeric>

#include "linear/cholesky/local_array.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

namespace {

/// The rows of B_t as columns, on rank 0.
SparseColumns columns_of_transpose(Mat B_t)
{
  const MPI_Comm comm = petsc::communicator(B_t);
  PetscInt first = 0, last = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(B_t, &first, &last));
  petsc::check(MatGetSize(B_t, &n_columns, nullptr));
  std::vector<int> lengths, rows;
  std::vector<double> values;
  for (PetscInt j = first; j < last; ++j) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* entries = nullptr;
    petsc::check(MatGetRow(B_t, j, &n, &columns, &entries));
    lengths.push_back(n);
    rows.insert(rows.end(), columns, columns + n);
    values.insert(values.end(), entries, entries + n);
    petsc::check(MatRestoreRow(B_t, j, &n, &columns, &entries));
  }
  lengths = gather(lengths, MPI_INT, comm);
  SparseColumns B{.n_columns = n_columns,
                  .starts = std::vector<int>(lengths.size() + 1, 0),
                  .rows = gather(rows, MPI_INT, comm),
                  .values = gather(values, MPI_DOUBLE, comm)};
  std::inclusive_scan(lengths.begin(), lengths.end(), B.starts.begin() + 1);
  return B;
}

/// Columns first to last of B, where it is.
SparseColumns slice(const SparseColumns& B, int first, int last)
{
  SparseColumns part{.n_columns = last - first, .starts = {}, .rows = {}, .values = {}};
  if (B.starts.size() < 2) return part;  // not on rank 0
  const int begin = B.starts[first], end = B.starts[last];
  for (int j = first; j <= last; ++j) part.starts.push_back(B.starts[j] - begin);
  part.rows.assign(B.rows.begin() + begin, B.rows.begin() + end);
  part.values.assign(B.values.begin() + begin, B.values.begin() + end);
  return part;
}

}  // namespace

CholeskyFactor& factor_of(Mat F)
{
  return *static_cast<CholeskyFactor*>(F->data);
}

PetscErrorCode solve_vector(Mat F, Vec b, Vec x)
{
  return guarded([&] {
    petsc::check(VecCopy(b, x));
    LocalColumns column{.values = nullptr, .leading_dimension = 0, .n_columns = 1};
    petsc::check(VecGetLocalSize(x, &column.leading_dimension));
    petsc::check(VecGetArray(x, &column.values));
    factor_of(F).solve(column);
    petsc::check(VecRestoreArray(x, &column.values));
  });
}

PetscErrorCode solve_block(Mat F, Mat B, Mat X)
{
  return guarded([&] {
    if (B != X) petsc::check(MatCopy(B, X, SAME_NONZERO_PATTERN));
    factor_of(F).solve(LocalArray(X).columns());
  });
}

PetscErrorCode solve_sparse(Mat F, Mat B_t, Mat X)
{
  return guarded([&] {
    CholeskyFactor& factor = factor_of(F);
    const SparseColumns B = columns_of_transpose(B_t);
    const LocalArray array(X);
    const LocalColumns all = array.columns();
    const int most = factor.columns_at_a_time();
    for (int first = 0; first < B.n_columns; first += most) {
      report_progress(double(first) / B.n_columns);
      const int last = std::min(first + most, B.n_columns);
      factor.solve(slice(B, first, last),
                   {.values = all.values + std::size_t(first) * all.leading_dimension,
                    .leading_dimension = all.leading_dimension,
                    .n_columns = last - first});
    }
  });
}

}  // namespace chladni::linear
