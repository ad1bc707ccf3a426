#include "reduce/error_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
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
      : A_(A), diagonal_s_(linear::diagonal(A.ss)), diagonal_m_(linear::diagonal(A.mm))
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

using Numbers = std::vector<PetscInt>;

ReducedPairs some_of(const ReducedPairs& pairs, const Numbers& numbers)
{
  ReducedPairs some{.X = pairs.X(every, numbers), .lambda = {}};
  for (const PetscInt k : numbers) some.lambda.push_back(pairs.lambda[std::size_t(k)]);
  return some;
}

/// Whether two motions have a coordinate in common that moves in both.
bool overlap(const Eigen::VectorXd& a, const Eigen::VectorXd& b)
{
  return (a.array() != 0.0 && b.array() != 0.0).any();
}

/// Pairs in groups that move different parts of the body.
std::vector<Numbers> groups_of(const ReducedPairs& pairs)
{
  struct Group {
    Eigen::VectorXd moved;
    Numbers pairs;
  };
  std::vector<Group> groups;
  for (PetscInt k = 0; k < pairs.X.cols(); ++k) {
    const Eigen::VectorXd x = pairs.X.col(k).cwiseAbs();
    const auto alike =
        std::ranges::find_if(groups, [&](const Group& g) { return overlap(g.moved, x); });
    if (alike == groups.end()) {
      groups.push_back({.moved = x, .pairs = {k}});
    } else {
      alike->moved += x;
      alike->pairs.push_back(k);
    }
  }
  std::vector<Numbers> numbers;
  for (Group& group : groups) numbers.push_back(std::move(group.pairs));
  return numbers;
}

/// Pairs in blocks of at most `most`; those that move different parts of the body, as bending and
/// motion in the plane do, in different ones, which are worked on without the rest. A few pairs are
/// not worth a block of their own.
std::vector<Numbers> blocks_of(const ReducedPairs& pairs, PetscInt most)
{
  constexpr std::ptrdiff_t few = 8;
  std::vector<Numbers> groups(1), blocks;
  for (const Numbers& group : groups_of(pairs))
    if (std::ssize(group) < few)
      groups.front().insert(groups.front().end(), group.begin(), group.end());
    else
      groups.push_back(group);
  for (const Numbers& group : groups) {
    for (std::size_t first = 0; first < group.size(); first += std::size_t(most)) {
      const std::size_t last = std::min(first + std::size_t(most), group.size());
      blocks.emplace_back(group.begin() + std::ptrdiff_t(first),
                          group.begin() + std::ptrdiff_t(last));
    }
  }
  return blocks;
}

/// r_i^T K_ss^-1 r_j / sqrt(lambda_i lambda_j) of the newest block with itself and all before.
void add_inner_products(const std::vector<linear::InverseForm>& forms,
                        std::span<const Numbers> numbers, const std::vector<double>& lambda,
                        MatrixXd& H)
{
  const Mat right = forms.back().right();
  const auto scale = [&](PetscInt i) { return 1.0 / std::sqrt(lambda[std::size_t(i)]); };
  const Numbers& newest = numbers[forms.size() - 1];
  for (std::size_t b = 0; b < forms.size(); ++b) {
    const MatrixXd products = linear::inner_product(forms[b].left, right);
    for (Eigen::Index j = 0; j < products.cols(); ++j) {
      for (Eigen::Index i = 0; i < products.rows(); ++i) {
        const PetscInt row = numbers[b][std::size_t(i)], column = newest[std::size_t(j)];
        H(row, column) = H(column, row) = products(i, j) * scale(row) * scale(column);
      }
    }
  }
}

}  // namespace

ErrorEstimates error_estimates(const Condensation& system, const ReducedPairs& pairs,
                               Purpose purpose)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const auto n_pairs = static_cast<PetscInt>(pairs.lambda.size());
  const PetscInt most =
      std::min(linear::columns_at_a_time(system.K_ss.matrix()), std::max<PetscInt>(n_pairs, 1));
  ErrorEstimates estimates{.eta2 = std::vector(std::size_t(n_pairs), 0.0),
                           .rounding = std::vector(std::size_t(n_pairs), 0.0),
                           .inner_products = {}};
  const bool with_inner_products = purpose == Purpose::bounds;
  if (with_inner_products) estimates.inner_products = MatrixXd::Zero(n_pairs, n_pairs);
  std::vector<linear::InverseForm> forms;  // of K_ss^-1, on r of the pairs so far
  BlockResiduals residuals(system, most);
  const std::vector<Numbers> blocks = blocks_of(pairs, most);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    linear::report_progress(double(b) / double(blocks.size()));
    const ReducedPairs some = some_of(pairs, blocks[b]);
    if (!with_inner_products) forms.clear();
    Residuals of = residuals.of(some);
    forms.push_back(linear::inverse_form(system.K_ss.factor(), std::move(of.r_s)));
    const std::vector<double> squares =
        linear::column_products(forms.back().left, forms.back().right());
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const auto k = static_cast<std::size_t>(blocks[b][i]);
      estimates.eta2[k] = std::max(0.0, squares[i]) / some.lambda[i];
      const double terms = of.energy_of_diagonal[i] / some.lambda[i] + of.inertia_of_diagonal[i];
      estimates.rounding[k] =
          4.0 * eps * terms + 2.0 * std::abs(some.lambda[i] / of.rayleigh[i] - 1.0);
    }
    if (with_inner_products) {
      add_inner_products(forms, std::span(blocks).first(b + 1), pairs.lambda,
                         estimates.inner_products);
    }
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
