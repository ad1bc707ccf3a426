#include "plugin/eps_residuals.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/eigen_every.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "plugin/eps_operator.hpp"

namespace chladni::plugin {

namespace {

/// The problem of an EPS with work vectors.
class Pencil {
 public:
  explicit Pencil(EPS eps) : taken_(shift_in_place(eps))
  {
    A_ = problem_matrices(eps).A;
    B_ = problem_matrices(eps).B;
    for (petsc::Vector* v : {&a_, &b_, &w_, &r_, &Bx_})
      petsc::check(MatCreateVecs(A_, v->put(), nullptr));
    take_diagonal(A_, a_);
    take_diagonal(B_, b_);
  }

  PairErrors errors(Vec x, const Eigenvalue& value)
  {
    constexpr double eps = std::numeric_limits<double>::epsilon(), round_off = 1e-12;
    const double size = weigh_rows(value.lambda);
    take_residual(x, value.lambda);
    PetscReal length = 0.0, residual = 0.0, terms = 0.0;
    petsc::check(VecNorm(x, NORM_2, &length));
    petsc::check(VecNorm(r_, NORM_2, &residual));
    PairErrors errors{};
    errors.printed = residual / (std::abs(value.lambda) * length);
    errors.round_off = 100.0 * eps * size / std::abs(value.lambda);
    const double scaled = scaled_length(r_), mass = scaled_length(Bx_);
    petsc::check(VecPointwiseMult(r_, w_, x));  // what cancels in A x
    petsc::check(VecNorm(r_, NORM_2, &terms));
    errors.scaled = scaled <= round_off * terms ? 0.0 : scaled / (value.distance * mass);
    return errors;
  }

 private:
  /// The absolute diagonal; 1 where A is the identity or a shell matrix that does not give it.
  static void take_diagonal(Mat A, Vec d)
  {
    PetscBool is_given = PETSC_FALSE;
    petsc::check(VecSet(d, 1.0));
    if (A) petsc::check(MatHasOperation(A, MATOP_GET_DIAGONAL, &is_given));
    if (is_given) petsc::check(MatGetDiagonal(A, d));
    petsc::check(VecAbs(d));
  }

  /// w <- the root of |A_ii| + |lambda B_ii|, by which rows are divided. Returns the largest sum.
  double weigh_rows(double lambda)
  {
    PetscReal largest = 0.0;
    petsc::check(VecWAXPY(w_, std::abs(lambda), b_, a_));
    petsc::check(VecMax(w_, nullptr, &largest));
    petsc::check(VecShift(w_, 1e-16 * largest));
    petsc::check(VecSqrtAbs(w_));
    return largest;
  }

  /// r <- A x - lambda B x, and B x
  void take_residual(Vec x, double lambda)
  {
    petsc::check(MatMult(A_, x, r_));
    if (B_)
      petsc::check(MatMult(B_, x, Bx_));
    else
      petsc::check(VecCopy(x, Bx_));
    petsc::check(VecAXPY(r_, taken_ - lambda, Bx_));
  }

  double scaled_length(Vec v)
  {
    PetscReal length = 0.0;
    petsc::check(VecPointwiseDivide(v, v, w_));
    petsc::check(VecNorm(v, NORM_2, &length));
    return length;
  }

  double taken_;  ///< from A
  Mat A_ = nullptr, B_ = nullptr;
  petsc::Vector a_, b_, w_, r_, Bx_;
};

/// A X, or B X, of a matrix that may do nothing but multiply vectors.
petsc::Matrix times(Mat A, Mat X)
{
  PetscInt n = 0;
  petsc::Matrix Y;
  petsc::check(MatGetSize(X, nullptr, &n));
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, Y.put()));
  if (A == nullptr) return Y;
  for (PetscInt j = 0; j < n; ++j) {
    Vec x = nullptr, y = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, j, &x));
    petsc::check(MatDenseGetColumnVecWrite(Y, j, &y));
    petsc::check(MatMult(A, x, y));
    petsc::check(MatDenseRestoreColumnVecWrite(Y, j, &y));
    petsc::check(MatDenseRestoreColumnVecRead(X, j, &x));
  }
  return Y;
}

/// X S
petsc::Matrix combined(Mat X, const Eigen::MatrixXd& S)
{
  petsc::Matrix Y = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(Y));
  linear::add_product(1.0, X, S, Y);
  return Y;
}

/// The places of values in the order that the user wants.
std::vector<PetscInt> wanted_order(EPS eps, const std::vector<double>& lambda)
{
  std::vector<PetscInt> order(lambda.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](PetscInt a, PetscInt b) {
    PetscInt sign = 0;
    petsc::check(eps->sc->comparison(lambda[std::size_t(a)], 0.0, lambda[std::size_t(b)], 0.0,
                                     &sign, eps->sc->comparisonctx));
    return sign < 0;
  });
  return order;
}

}  // namespace

Eigenvalue eigenvalue(EPS eps, double theta)
{
  PetscScalar lambda = theta, zero = 0.0, shift = 0.0;
  PetscBool is_inverse = PETSC_FALSE, is_shift = PETSC_FALSE;
  petsc::check(STBackTransform(eps->st, 1, &lambda, &zero));
  petsc::check(STGetShift(eps->st, &shift));
  petsc::check(
      PetscObjectTypeCompareAny((PetscObject)eps->st, &is_inverse, STSINVERT, STCAYLEY, ""));
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSHIFT, &is_shift));
  if (inverts(eps)) return {.lambda = lambda, .distance = std::abs(1.0 / theta)};
  if (is_inverse) return {.lambda = lambda, .distance = std::abs(lambda - shift)};
  return {.lambda = lambda, .distance = std::abs(is_shift ? theta : lambda)};
}

std::vector<PairErrors> pair_errors(EPS eps, Mat X, std::span<const Eigenvalue> values)
{
  Pencil pencil(eps);
  std::vector<PairErrors> errors;
  for (std::size_t i = 0; i < values.size(); ++i) {
    Vec x = nullptr;
    petsc::check(MatDenseGetColumnVecRead(X, static_cast<PetscInt>(i), &x));
    errors.push_back(pencil.errors(x, values[i]));
    petsc::check(MatDenseRestoreColumnVecRead(X, static_cast<PetscInt>(i), &x));
  }
  return errors;
}

Pairs refined(EPS eps, Mat X, const linear::BlockOperator& op)
{
  constexpr double independent = 1e-12;
  const auto [A, B] = problem_matrices(eps);
  const MPI_Comm comm = petsc::communicator(X);
  petsc::Matrix Y;
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, Y.put()));
  op(X, times(B, X), Y);
  const Eigen::MatrixXd G = linear::inner_product(Y, times(B, Y));
  std::vector<double> sizes;
  for (Eigen::Index j = 0; j < G.cols(); ++j) sizes.push_back(std::sqrt(std::max(G(j, j), 0.0)));
  const linear::Orthonormalisation o = linear::orthonormalisation(G, sizes, independent, comm);
  const petsc::Matrix Q = combined(Y, o.to_Q);
  const linear::SymmetricEigen ritz =
      linear::symmetric_eigen(linear::inner_product(Q, times(A, Q)), comm);
  std::vector<double> lambda = ritz.values;
  for (double& value : lambda) value += shift_in_place(eps);
  const std::vector<PetscInt> order = wanted_order(eps, lambda);
  Pairs pairs{.lambda = {}, .X = combined(Q, Eigen::MatrixXd(ritz.vectors(every, order)))};
  for (const PetscInt i : order) pairs.lambda.push_back(lambda[std::size_t(i)]);
  return pairs;
}

}  // namespace chladni::plugin
