#include "linear/kernels/small_matrices.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/eigenmodes.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

MatrixXd product(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd C = MatrixXd::Zero(A.rows(), B.cols());
  add_product(1.0, A.data(), static_cast<PetscInt>(A.rows()), B, 0.0, C.data());
  return C;
}

MatrixXd solution(MatrixXd A, MatrixXd B)
{
  const auto n = static_cast<PetscBLASInt>(A.rows()), m = static_cast<PetscBLASInt>(B.cols());
  if (n == 0 || m == 0) return B;
  std::vector<PetscBLASInt> pivots(static_cast<std::size_t>(n));
  PetscBLASInt info = 0;
  LAPACKgesv_(&n, &m, A.data(), &n, pivots.data(), B.data(), &n, &info);
  if (info != 0) throw Error(fmt::format("solution: the matrix is singular at row {}", info));
  return B;
}

MatrixXd stacked(const MatrixXd& A, const MatrixXd& B)
{
  MatrixXd C(A.rows() + B.rows(), B.cols());
  C.topRows(A.rows()) = A;
  C.bottomRows(B.rows()) = B;
  return C;
}

void add_product(double alpha, const double* X, PetscInt n_local, const MatrixXd& S, double beta,
                 double* Y)
{
  const PetscBLASInt m = n_local;
  const auto n = static_cast<PetscBLASInt>(S.cols()), k = static_cast<PetscBLASInt>(S.rows());
  if (m == 0 || n == 0 || k == 0) return;
  BLASgemm_("N", "N", &m, &n, &k, &alpha, X, &m, S.data(), &k, &beta, Y, &m);
}

}  // namespace chladni::linear

// LAPACK's symbol: PETSc declares dsyev only, which is several times slower with vectors.
extern "C" void dsyevd_(const char* jobz,
                        const char* uplo,  // NOLINT(readability-identifier-naming)
                        const int* n, double* a, const int* lda, double* w, double* work,
                        const int* lwork, int* iwork, const int* liwork, int* info);

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

/// With errors relative to the largest eigenvalue.
SymmetricEigen by_lapack(MatrixXd A)
{
  const auto n = static_cast<int>(A.rows());
  SymmetricEigen eigen{.values = std::vector<double>(n), .vectors = {}};
  if (n == 0) return eigen;
  int info = 0, work_size = -1, integer_size = -1, integers_needed = 0;
  double work_needed = 0.0;
  dsyevd_("V", "U", &n, A.data(), &n, eigen.values.data(), &work_needed, &work_size,
          &integers_needed, &integer_size, &info);
  work_size = static_cast<int>(work_needed);
  integer_size = integers_needed;
  std::vector<double> work(work_size);
  std::vector<int> integers(integer_size);
  dsyevd_("V", "U", &n, A.data(), &n, eigen.values.data(), work.data(), &work_size, integers.data(),
          &integer_size, &info);
  if (info != 0) throw Error(fmt::format("symmetric_eigen: LAPACK dsyevd failed with {}", info));
  eigen.vectors = std::move(A);
  return eigen;
}

/// Rows of large diagonal entries, and the others.
struct Grading {
  std::vector<PetscInt> large, small;
};

double largest_entry(const MatrixXd& A, const std::vector<PetscInt>& rows)
{
  double largest = 0.0;
  for (const PetscInt j : rows)
    for (const PetscInt i : rows) largest = std::max(largest, std::abs(A(i, j)));
  return largest;
}

/// A gap between the diagonal entries, all others among the small rows lying below it; nothing
/// large where there is none.
Grading grading(const MatrixXd& A)
{
  constexpr double gap = 1e4;
  std::vector<PetscInt> rows(A.rows());
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
void rotate(MatrixXd& A, MatrixXd& V, PetscInt r, PetscInt j)
{
  const double half_gap = 0.5 * (A(r, r) - A(j, j));
  const double t = A(r, j) / (half_gap + std::copysign(std::hypot(half_gap, A(r, j)), half_gap));
  const double c = 1.0 / std::hypot(1.0, t), s = t * c;
  A(r, r) += t * A(r, j);
  A(j, j) -= t * A(r, j);
  A(r, j) = A(j, r) = 0.0;
  for (PetscInt k = 0; k < A.rows(); ++k) {
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
bool decouple(const Grading& rows, MatrixXd& A, MatrixXd& V)
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

/// Ascending, those of equal value in their order.
SymmetricEigen sorted(SymmetricEigen all)
{
  std::vector<PetscInt> order(all.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::less<>(), [&](PetscInt i) { return all.values[i]; });
  std::vector<double> values;
  for (const PetscInt i : order) values.push_back(all.values[i]);
  return {.values = std::move(values), .vectors = all.vectors(every, order)};
}

/// Of sets of rows that A does not couple, each by itself: no vector has round-off in another set.
SymmetricEigen set_by_set(const MatrixXd& A, const std::vector<std::vector<Eigen::Index>>& sets)
{
  SymmetricEigen all{.values = {}, .vectors = MatrixXd::Zero(A.rows(), A.cols())};
  for (const std::vector<Eigen::Index>& set : sets) {
    const SymmetricEigen own = symmetric_eigen(A(set, set));
    const auto first = static_cast<Eigen::Index>(all.values.size());
    all.vectors(set, Eigen::seqN(first, own.vectors.cols())) = own.vectors;
    all.values.insert(all.values.end(), own.values.begin(), own.values.end());
  }
  return sorted(std::move(all));
}

}  // namespace

SymmetricEigen symmetric_eigen(Eigen::MatrixXd A)
{
  if (A.rows() == 0) return {};
  if (const auto sets = decoupled_coordinates(A, A); sets.size() > 1) return set_by_set(A, sets);
  const Grading rows = grading(A);
  if (rows.large.empty()) return by_lapack(std::move(A));
  MatrixXd D = A, V = MatrixXd::Identity(A.rows(), A.rows());
  if (!decouple(rows, D, V)) return by_lapack(std::move(A));
  const SymmetricEigen large = symmetric_eigen(D(rows.large, rows.large));
  const SymmetricEigen small = symmetric_eigen(D(rows.small, rows.small));
  SymmetricEigen both{.values = large.values, .vectors = MatrixXd(A.rows(), A.cols())};
  both.values.insert(both.values.end(), small.values.begin(), small.values.end());
  both.vectors << product(V(every, rows.large), large.vectors),
      product(V(every, rows.small), small.vectors);
  return sorted(std::move(both));
}

SymmetricEigen symmetric_eigen(Eigen::MatrixXd A, MPI_Comm comm)
{
  const auto n = static_cast<PetscInt>(A.rows());
  SymmetricEigen eigen;
  int is_solved = 1;
  if (petsc::rank(comm) == 0) {
    try {
      eigen = symmetric_eigen(std::move(A));
    } catch (const Error&) {
      is_solved = 0;
    }
  } else {
    eigen = {.values = std::vector<double>(n), .vectors = MatrixXd(n, n)};
  }
  MPI_Bcast(&is_solved, 1, MPI_INT, 0, comm);
  if (is_solved == 0) throw Error("symmetric_eigen: LAPACK dsyevd failed on the first rank");
  MPI_Datatype column = MPI_DATATYPE_NULL;  // n x n may be more than an int counts
  MPI_Type_contiguous(n, MPI_DOUBLE, &column);
  MPI_Type_commit(&column);
  MPI_Bcast(eigen.values.data(), 1, column, 0, comm);
  MPI_Bcast(eigen.vectors.data(), n, column, 0, comm);
  MPI_Type_free(&column);
  return eigen;
}

}  // namespace chladni::linear
