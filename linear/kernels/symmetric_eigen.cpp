#include "linear/kernels/symmetric_eigen.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

// LAPACK's symbol: PETSc declares dsyev only, which is several times slower with vectors.
extern "C" void dsyevd_(const char* jobz,
                        const char* uplo,  // NOLINT(readability-identifier-naming)
                        const int* n, double* a, const int* lda, double* w, double* work,
                        const int* lwork, int* iwork, const int* liwork, int* info);

namespace chladni::linear {

namespace {

/// With errors relative to the largest eigenvalue.
SymmetricEigen by_lapack(SmallMatrix A)
{
  const int n = A.n_rows;
  SymmetricEigen eigen{.values = std::vector<double>(n), .vectors = {0, 0}};
  if (n == 0) return eigen;
  int info = 0, work_size = -1, integer_size = -1, integers_needed = 0;
  double work_needed = 0.0;
  dsyevd_("V", "U", &n, A.values.data(), &n, eigen.values.data(), &work_needed, &work_size,
          &integers_needed, &integer_size, &info);
  work_size = static_cast<int>(work_needed);
  integer_size = integers_needed;
  std::vector<double> work(work_size);
  std::vector<int> integers(integer_size);
  dsyevd_("V", "U", &n, A.values.data(), &n, eigen.values.data(), work.data(), &work_size,
          integers.data(), &integer_size, &info);
  if (info != 0) throw Error(fmt::format("symmetric_eigen: LAPACK dsyevd failed with {}", info));
  eigen.vectors = std::move(A);
  return eigen;
}

/// Rows of large diagonal entries, and the others.
struct Grading {
  std::vector<PetscInt> large, small;
};

double largest_entry(const SmallMatrix& A, const std::vector<PetscInt>& rows)
{
  double largest = 0.0;
  for (const PetscInt j : rows) {
    for (const PetscInt i : rows) largest = std::max(largest, std::abs(A(i, j)));
  }
  return largest;
}

/// A gap between the diagonal entries, all others among the small rows lying below it; nothing
/// large where there is none.
Grading grading(const SmallMatrix& A)
{
  constexpr double gap = 1e4;
  std::vector<PetscInt> rows(A.n_rows);
  std::iota(rows.begin(), rows.end(), 0);
  const auto size = [&](PetscInt i) { return std::abs(A(i, i)); };
  std::ranges::stable_sort(rows, [&](PetscInt a, PetscInt b) { return size(a) > size(b); });
  for (auto at = rows.begin() + 1; at < rows.end(); ++at) {
    if (size(at[-1]) <= gap * size(*at)) continue;
    Grading found{.large = {rows.begin(), at}, .small = {at, rows.end()}};
    if (size(at[-1]) > gap * largest_entry(A, found.small)) return found;
  }
  return {.large = {}, .small = std::move(rows)};
}

/// A <- J^T A J, V <- V J with the rotation J of rows r and j that makes A(r, j) zero.
void rotate(SmallMatrix& A, SmallMatrix& V, PetscInt r, PetscInt j)
{
  const double half_gap = 0.5 * (A(r, r) - A(j, j));
  const double t = A(r, j) / (half_gap + std::copysign(std::hypot(half_gap, A(r, j)), half_gap));
  const double c = 1.0 / std::hypot(1.0, t), s = t * c;
  A(r, r) += t * A(r, j);
  A(j, j) -= t * A(r, j);
  A(r, j) = A(j, r) = 0.0;
  for (PetscInt k = 0; k < A.n_rows; ++k) {
    if (k != r && k != j) {
      const double a_r = A(k, r), a_j = A(k, j);
      A(k, r) = A(r, k) = c * a_r + s * a_j;
      A(k, j) = A(j, k) = c * a_j - s * a_r;
    }
    const double v_r = V(k, r), v_j = V(k, j);
    V(k, r) = c * v_r + s * v_j;
    V(k, j) = c * v_j - s * v_r;
  }
}

/// Rotates the coupling of large and small rows away (Jacobi); whether that ended.
bool decouple(const Grading& rows, SmallMatrix& A, SmallMatrix& V)
{
  constexpr int most_sweeps = 8;
  constexpr double eps = std::numeric_limits<double>::epsilon();
  bool ended = false;
  for (int sweep = 0; !ended && sweep < most_sweeps; ++sweep) {
    ended = true;
    for (const PetscInt r : rows.large) {
      for (const PetscInt j : rows.small) {
        if (std::abs(A(r, j)) <= 0.01 * eps * std::abs(A(r, r) - A(j, j))) continue;
        ended = false;
        rotate(A, V, r, j);
      }
    }
  }
  return ended;
}

SmallMatrix submatrix(const SmallMatrix& A, const std::vector<PetscInt>& rows)
{
  const auto n = static_cast<PetscInt>(rows.size());
  SmallMatrix B(n, n);
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = 0; i < n; ++i) B(i, j) = A(rows[i], rows[j]);
  }
  return B;
}

/// V Z for the columns of V that belong to the rows of a block, whose eigenvectors are Z.
SmallMatrix in_all_rows(const SmallMatrix& V, const std::vector<PetscInt>& rows,
                        const SmallMatrix& Z)
{
  SmallMatrix V_block(V.n_rows, Z.n_rows), X(V.n_rows, Z.n_cols);
  for (PetscInt j = 0; j < Z.n_rows; ++j) {
    for (PetscInt i = 0; i < V.n_rows; ++i) V_block(i, j) = V(i, rows[j]);
  }
  const PetscBLASInt m = V.n_rows, n = Z.n_cols, k = Z.n_rows;
  const double one = 1.0, zero = 0.0;
  BLASgemm_("N", "N", &m, &n, &k, &one, V_block.values.data(), &m, Z.values.data(), &k, &zero,
            X.values.data(), &m);
  return X;
}

/// The pairs of the two blocks in ascending order.
SymmetricEigen merged(const SymmetricEigen& a, const SymmetricEigen& b)
{
  const auto n_a = static_cast<PetscInt>(a.values.size());
  const auto n = n_a + static_cast<PetscInt>(b.values.size());
  std::vector<PetscInt> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto value = [&](PetscInt i) { return i < n_a ? a.values[i] : b.values[i - n_a]; };
  std::ranges::stable_sort(order, std::less<>(), value);
  SymmetricEigen all{.values = {}, .vectors = {n, n}};
  for (PetscInt k = 0; k < n; ++k) {
    all.values.push_back(value(order[k]));
    for (PetscInt i = 0; i < n; ++i) {
      all.vectors(i, k) = order[k] < n_a ? a.vectors(i, order[k]) : b.vectors(i, order[k] - n_a);
    }
  }
  return all;
}

}  // namespace

SymmetricEigen symmetric_eigen(SmallMatrix A)
{
  if (A.n_rows == 0) return {{}, {0, 0}};
  const Grading rows = grading(A);
  if (rows.large.empty()) return by_lapack(std::move(A));
  SmallMatrix D = A, V(A.n_rows, A.n_rows);
  for (PetscInt i = 0; i < V.n_rows; ++i) V(i, i) = 1.0;
  if (!decouple(rows, D, V)) return by_lapack(std::move(A));
  SymmetricEigen large = symmetric_eigen(submatrix(D, rows.large));
  SymmetricEigen small = symmetric_eigen(submatrix(D, rows.small));
  large.vectors = in_all_rows(V, rows.large, large.vectors);
  small.vectors = in_all_rows(V, rows.small, small.vectors);
  return merged(large, small);
}

SymmetricEigen symmetric_eigen(SmallMatrix A, MPI_Comm comm)
{
  const PetscInt n = A.n_rows;
  SymmetricEigen eigen{.values = {}, .vectors = {0, 0}};
  int is_solved = 1;
  if (petsc::rank(comm) == 0) {
    try {
      eigen = symmetric_eigen(std::move(A));
    } catch (const Error&) {
      is_solved = 0;
    }
  } else {
    eigen = {.values = std::vector<double>(n), .vectors = {n, n}};
  }
  MPI_Bcast(&is_solved, 1, MPI_INT, 0, comm);
  if (is_solved == 0) throw Error("symmetric_eigen: LAPACK dsyevd failed on the first rank");
  MPI_Datatype column = MPI_DATATYPE_NULL;  // n x n may be more than an int counts
  MPI_Type_contiguous(n, MPI_DOUBLE, &column);
  MPI_Type_commit(&column);
  MPI_Bcast(eigen.values.data(), 1, column, 0, comm);
  MPI_Bcast(eigen.vectors.values.data(), n, column, 0, comm);
  MPI_Type_free(&column);
  return eigen;
}

}  // namespace chladni::linear
