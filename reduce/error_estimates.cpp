#include "reduce/error_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "linear/cholesky/inverse_form.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// Of motions u: the residual at the slaves, the sum of K_jj u_j^2 over all DOFs, that of M_jj
/// u_j^2 over u^T M u, and the Rayleigh quotient by the matrices of the FE model.
struct Residuals {
  petsc::Matrix r_s;
  std::vector<double> energy_of_diagonal, inertia_of_diagonal;
  std::vector<double> rayleigh;
};

/// u^T A u of each column of u = (u_s, x_m).
/// @param A_u_s  A_ss u_s
std::vector<double> quadratic_forms(const Blocks& A, Mat A_u_s, Mat u_s, const MatrixXd& x_m)
{
  const std::vector<double> ss = linear::column_products(u_s, A_u_s);
  const MatrixXd sm = linear::inner_product_sparse(u_s, A.sm);
  const MatrixXd mm = linear::replicate(A.mm);
  std::vector<double> forms;
  for (PetscInt k = 0; k < x_m.cols(); ++k) {
    double form = ss[k];
    for (PetscInt j = 0; j < x_m.rows(); ++j) {
      double row = 2.0 * sm(k, j);
      for (PetscInt i = 0; i < x_m.rows(); ++i) row += x_m(i, k) * mm(i, j);
      form += row * x_m(j, k);
    }
    forms.push_back(form);
  }
  return forms;
}

petsc::Vector diagonal_of(Mat A)
{
  petsc::Vector diagonal;
  petsc::check(MatCreateVecs(A, diagonal.put(), nullptr));
  petsc::check(MatGetDiagonal(A, diagonal));
  return diagonal;
}

/// Adds to sums_k the sum of d_j X(j, k)^2 over the local rows j.
template <typename Value>
void add_diagonal_form(Vec d, const Value& X, std::vector<double>& sums)
{
  PetscInt n_local = 0;
  const PetscScalar* d_j = nullptr;
  petsc::check(VecGetLocalSize(d, &n_local));
  petsc::check(VecGetArrayRead(d, &d_j));
  for (std::size_t k = 0; k < sums.size(); ++k) {
    for (PetscInt j = 0; j < n_local; ++j) {
      const double x = X(j, static_cast<PetscInt>(k));
      sums[k] += d_j[j] * x * x;
    }
  }
  petsc::check(VecRestoreArrayRead(d, &d_j));
}

/// A matrix in the forms that estimates need of it.
class EstimatedForm {
 public:
  explicit EstimatedForm(const Blocks& A)
      : A_(A), diagonal_s_(diagonal_of(A.ss)), diagonal_m_(diagonal_of(A.mm))
  {}

  const Blocks& blocks() const { return A_; }
  /// A_u_s <- A_ss u_s. Its workspace is not kept: that of K and M together is a large part of it.
  void apply(Mat u_s, Mat A_u_s) const { linear::SparseProduct(A_.ss).apply(u_s, A_u_s); }

  /// The sum of A_jj u_j^2 over all DOFs of each column of u = (u_s, x_m).
  std::vector<double> of_diagonal(Mat u_s, const MatrixXd& x_m) const
  {
    std::vector<double> sums(x_m.cols(), 0.0);
    add_diagonal_form(diagonal_s_, linear::LocalRows(u_s), sums);
    PetscInt first = 0;
    petsc::check(MatGetOwnershipRange(A_.mm, &first, nullptr));
    add_diagonal_form(
        diagonal_m_, [&](PetscInt j, PetscInt k) { return x_m(first + j, k); }, sums);
    linear::sum_over_ranks(sums, petsc::communicator(A_.ss));
    return sums;
  }

 private:
  const Blocks& A_;
  petsc::Vector diagonal_s_, diagonal_m_;
};

/// The residuals of reduced pairs, block by block in the same memory.
class BlockResiduals {
 public:
  /// @param most  pairs of a block
  BlockResiduals(const Condensation& system, PetscInt most)
      : Q_CB_(system.Q_CB),
        K_(system.K),
        M_(system.M),
        motion_(linear::uninitialized_dense(system.K.ss, most)),
        product_(linear::uninitialized_dense(system.K.ss, most))
  {}

  /// r_s = K_ss Phi x_q - lambda (M_ss u_s + M_sm x_m): the constraint modes balance K by
  /// themselves, and leaving them out avoids the difference of two large forces.
  Residuals of(const ReducedPairs& pairs)
  {
    PetscInt n_m = 0;
    petsc::check(MatGetSize(Q_CB_.Psi, nullptr, &n_m));
    const auto n = static_cast<PetscInt>(pairs.X.cols());
    const MatrixXd x_m = pairs.X.topRows(n_m), x_q = pairs.X.bottomRows(pairs.X.rows() - n_m);
    const linear::ColumnRange u_s(motion_, 0, n), product(product_, 0, n);
    petsc::Matrix r = linear::uninitialized_dense(K_.blocks().ss, n);
    petsc::check(MatZeroEntries(u_s));
    if (Q_CB_.modes) linear::add_product(1.0, Q_CB_.modes->Phi, x_q, u_s);
    K_.apply(u_s, r);  // of Phi x_q alone
    linear::add_product(1.0, Q_CB_.Psi, x_m, u_s);
    K_.apply(u_s, product);
    std::vector<double> rayleigh = quadratic_forms(K_.blocks(), product, u_s, x_m);
    M_.apply(u_s, product);
    const std::vector<double> inertia = quadratic_forms(M_.blocks(), product, u_s, x_m);
    std::vector<double> inertia_of_diagonal = M_.of_diagonal(u_s, x_m);
    for (std::size_t k = 0; k < rayleigh.size(); ++k) {
      rayleigh[k] /= inertia[k];
      inertia_of_diagonal[k] /= inertia[k];
    }
    linear::add_sparse_product(M_.blocks().sm, x_m, product);
    MatrixXd minus_lambda = MatrixXd::Zero(n, n);
    for (PetscInt i = 0; i < n; ++i) minus_lambda(i, i) = -pairs.lambda[i];
    linear::add_product(1.0, product, minus_lambda, r);
    return {.r_s = std::move(r),
            .energy_of_diagonal = K_.of_diagonal(u_s, x_m),
            .inertia_of_diagonal = std::move(inertia_of_diagonal),
            .rayleigh = std::move(rayleigh)};
  }

 private:
  const CraigBamptonBasis& Q_CB_;
  EstimatedForm K_, M_;
  petsc::Matrix motion_, product_;
};

ReducedPairs slice(const ReducedPairs& pairs, PetscInt first, PetscInt last)
{
  return {.X = pairs.X.middleCols(first, last - first),
          .lambda = {pairs.lambda.begin() + first, pairs.lambda.begin() + last}};
}

/// r_i^T K_ss^-1 r_j / sqrt(lambda_i lambda_j) of the newest block with itself and all before.
void add_inner_products(const std::vector<linear::InverseForm>& forms,
                        const std::vector<double>& lambda, MatrixXd& H)
{
  const Mat right = forms.back().right();
  PetscInt newest = 0, first = 0;
  for (const linear::InverseForm& form : std::span(forms).first(forms.size() - 1))
    newest += linear::LocalRows(form.left).n_cols();
  for (const linear::InverseForm& form : forms) {
    const MatrixXd products = linear::inner_product(form.left, right);
    for (PetscInt j = 0; j < products.cols(); ++j) {
      for (PetscInt i = 0; i < products.rows(); ++i) {
        const double scale = std::sqrt(lambda[first + i] * lambda[newest + j]);
        H(first + i, newest + j) = H(newest + j, first + i) = products(i, j) / scale;
      }
    }
    first += static_cast<PetscInt>(products.rows());
  }
}

}  // namespace

ErrorEstimates error_estimates(const Condensation& system, const ReducedPairs& pairs,
                               Purpose purpose)
{
  const PetscInt most = linear::columns_at_a_time(system.K_ss.matrix());
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const auto n_pairs = static_cast<PetscInt>(pairs.lambda.size());
  ErrorEstimates estimates;
  const bool with_inner_products = purpose == Purpose::bounds;
  if (with_inner_products) estimates.inner_products = MatrixXd::Zero(n_pairs, n_pairs);
  std::vector<linear::InverseForm> forms;  // of K_ss^-1, on r of the pairs so far
  BlockResiduals residuals(system, std::min(most, n_pairs));
  for (PetscInt first = 0; first < n_pairs; first += most) {
    linear::report_progress(double(first) / n_pairs);
    const ReducedPairs some = slice(pairs, first, std::min(first + most, n_pairs));
    if (!with_inner_products) forms.clear();
    Residuals of = residuals.of(some);
    forms.push_back(linear::inverse_form(system.K_ss.factor(), std::move(of.r_s)));
    const std::vector<double> squares =
        linear::column_products(forms.back().left, forms.back().right());
    for (std::size_t i = 0; i < squares.size(); ++i) {
      estimates.eta2.push_back(std::max(0.0, squares[i]) / some.lambda[i]);
      const double terms = of.energy_of_diagonal[i] / some.lambda[i] + of.inertia_of_diagonal[i];
      estimates.rounding.push_back(4.0 * eps * terms +
                                   2.0 * std::abs(some.lambda[i] / of.rayleigh[i] - 1.0));
    }
    if (with_inner_products) add_inner_products(forms, pairs.lambda, estimates.inner_products);
  }
  return estimates;
}

double frequency_error(double eta2, double lambda, double lambda_left_out)
{
  constexpr double least = 0.02;  // close to the modes left out nothing is known
  return 0.5 * eta2 / std::max(least, 1.0 - lambda / lambda_left_out);
}

std::vector<double> frequency_errors_by_place(const std::vector<double>& lambda,
                                              const std::vector<double>& eta2,
                                              double lambda_left_out)
{
  std::vector<double> omega;  // of the FE model, by the estimates
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    // Near the modes left out the correction is uncertain, and would send a mode past many others.
    constexpr double furthest = 0.5;
    const double error =
        frequency_error(eta2[i], std::min(lambda[i], furthest * lambda_left_out), lambda_left_out);
    omega.push_back(std::sqrt(lambda[i]) / (1.0 + error));
  }
  std::ranges::sort(omega);
  for (std::size_t i = 0; i < lambda.size(); ++i) omega[i] = std::sqrt(lambda[i]) / omega[i] - 1.0;
  return omega;
}

}  // namespace chladni::reduce
