#include "reduce/residual_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "common/eigen_every.hpp"
#include "linear/cholesky/inverse_form.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "reduce/block_rows.hpp"

namespace chladni::reduce {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

petsc::Matrix solved(Mat factor, Mat F)
{
  petsc::Matrix z = linear::uninitialized_dense(F, linear::LocalRows(F).n_cols());
  petsc::check(MatMatSolve(factor, F, z));
  return z;
}

/// A copy of some columns.
petsc::Matrix columns_of(Mat X, std::span<const int> numbers)
{
  petsc::Matrix some = linear::uninitialized_dense(X, std::ssize(numbers));
  const linear::LocalRows all(X);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(some, &values));
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    std::copy_n(all.values() + std::size_t(numbers[j]) * all.leading_dimension(), all.n_rows(),
                values + j * all.n_rows());
  }
  petsc::check(MatDenseRestoreArrayWrite(some, &values));
  return some;
}

petsc::Matrix combined(Mat X, const MatrixXd& S)
{
  petsc::Matrix XS = linear::uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(XS));
  linear::add_product(1.0, X, S, XS);
  return XS;
}

MatrixXd symmetric(const MatrixXd& A)
{
  return 0.5 * (A + A.transpose());
}

/// A bordered by further rows and columns.
MatrixXd bordered(const MatrixXd& A, const MatrixXd& above, const MatrixXd& corner)
{
  const Index n = A.rows(), k = corner.rows();
  MatrixXd B(n + k, n + k);
  B.topLeftCorner(n, n) = A;
  B.topRightCorner(n, k) = above;
  B.bottomLeftCorner(k, n) = above.transpose();
  B.bottomRightCorner(k, k) = corner;
  return B;
}

VectorXd stiffness_of_modes(const ReducedModel& model)
{
  return model.K.diagonal().tail(std::ssize(model.omega));
}

/// The shapes less their share of the basis, made K-orthonormal.
/// @param lambda  K_qq
petsc::Matrix orthonormal(Mat shapes, Mat Phi, const VectorXd& lambda, Mat K)
{
  constexpr double dependent = 1e-6;  // of their lengths: what a Gram matrix resolves
  petsc::Matrix Z;
  petsc::check(MatDuplicate(shapes, MAT_COPY_VALUES, Z.put()));
  const petsc::Matrix KZ = linear::sparse_product(K, Z);
  const MatrixXd share = lambda.cwiseInverse().asDiagonal() * linear::inner_product(Phi, KZ);
  const MatrixXd G = symmetric(linear::inner_product(Z, KZ));
  linear::add_product(-1.0, Phi, share, Z);
  const MatrixXd left = G - linear::product(share.transpose(), lambda.asDiagonal() * share);
  const std::vector<double> units(static_cast<std::size_t>(G.rows()), 1.0);
  const linear::Orthonormalisation o =
      linear::orthonormalisation(left, units, dependent, petsc::communicator(K));
  return combined(Z, o.to_Q);
}

}  // namespace

ResidualForms::ResidualForms(const GrowingBasis& basis) : of_(basis)
{
  moving_ = of_.moving.value_or(std::vector<int>(std::size_t(of_.model.n_masters)));
  if (!of_.moving) std::iota(moving_.begin(), moving_.end(), 0);
  const MatrixXd H_mm = forms_of_masters();
  linear::InverseForm D = linear::inverse_form(
      of_.K_ss.factor(), linear::sparse_product(of_.M.ss, of_.Q_CB.modes->Phi));
  H_ = bordered(H_mm, with_masters(D.right()), symmetric(linear::inner_product(D.left, D.right())));
  left_D_ = std::move(D.left);
}

MatrixXd ResidualForms::forms_of_masters()
{
  constexpr PetscInt most = 64;  // columns of B at a time
  const auto n = static_cast<PetscInt>(moving_.size());
  const PetscInt n_m = of_.model.n_masters;
  left_B_ = linear::uninitialized_dense(of_.K.ss, n);
  MatrixXd unit = MatrixXd::Zero(n_m, n);
  for (PetscInt j = 0; j < n; ++j) unit(moving_[std::size_t(j)], j) = 1.0;
  MatrixXd H = MatrixXd::Zero(n, n);
  for (PetscInt first = 0; first < n; first += most) {
    const PetscInt last = std::min(first + most, n);
    petsc::Matrix B = linear::sparse_product(
        of_.M.ss,
        columns_of(of_.Q_CB.Psi, std::span(moving_).subspan(first, std::size_t(last - first))));
    linear::add_sparse_product(of_.M.sm, unit.middleCols(first, last - first), B);
    const linear::InverseForm form = linear::inverse_form(of_.K_ss.factor(), std::move(B));
    petsc::check(
        MatCopy(form.left, linear::ColumnRange(left_B_, first, last), SAME_NONZERO_PATTERN));
    H.block(0, first, last, last - first) =
        linear::inner_product(linear::ColumnRange(left_B_, 0, last), form.right());
  }
  MatrixXd of_all = MatrixXd::Zero(n_m, n_m);
  of_all(moving_, moving_) = MatrixXd(H.selfadjointView<Eigen::Upper>());
  return of_all;
}

MatrixXd ResidualForms::with_masters(Mat right) const
{
  MatrixXd forms = MatrixXd::Zero(of_.model.n_masters, linear::LocalRows(right).n_cols());
  forms(moving_, every) = linear::inner_product(left_B_, right);
  return forms;
}

MatrixXd ResidualForms::energy(const MatrixXd& X, double s) const
{
  const Index n_q = std::ssize(of_.model.omega);
  const MatrixXd X_q = X.bottomRows(n_q);
  MatrixXd G = s * s * linear::product(X.transpose(), linear::product(H_, X));
  G += X_q.transpose() * (stiffness_of_modes(of_.model).asDiagonal() * X_q);
  const MatrixXd momentum = linear::product(of_.model.M.bottomRows(n_q), X);
  G -= 2.0 * s * linear::product(X_q.transpose(), momentum);
  return symmetric(G);
}

petsc::Matrix ResidualForms::shapes(const MatrixXd& X, double s) const
{
  const Index n_q = std::ssize(of_.model.omega);
  const MatrixXd X_m = X.topRows(X.rows() - n_q), X_q = X.bottomRows(n_q);
  petsc::Matrix z = combined(of_.Q_CB.modes->Phi, X_q);
  petsc::Matrix u;
  petsc::check(MatDuplicate(z, MAT_COPY_VALUES, u.put()));
  linear::add_product(1.0, of_.Q_CB.Psi, X_m, u);
  const petsc::Matrix inertia = linear::sparse_product(of_.M.ss, u);
  linear::add_sparse_product(of_.M.sm, X_m, inertia);
  petsc::check(MatAXPY(z, -s, solved(of_.K_ss.factor(), inertia), SAME_NONZERO_PATTERN));
  return z;
}

void ResidualForms::append(Mat shapes)
{
  ReducedModel& model = of_.model;
  FixedInterfaceModes& modes = *of_.Q_CB.modes;
  const petsc::Matrix Z = orthonormal(shapes, modes.Phi, stiffness_of_modes(model), of_.K.ss);
  const PetscInt k = linear::LocalRows(Z).n_cols();
  petsc::Matrix D = linear::sparse_product(of_.M.ss, Z);
  MatrixXd above(model.M.rows(), k), H_above(H_.rows(), k);
  above.topRows(model.n_masters) = linear::inner_product(of_.Q_CB.Psi, D) +
                                   linear::inner_product_sparse(Z, of_.M.sm).transpose();
  above.bottomRows(std::ssize(model.omega)) = linear::inner_product(modes.Phi, D);
  model.M = bordered(model.M, above, symmetric(linear::inner_product(Z, D)));
  const linear::InverseForm form = linear::inverse_form(of_.K_ss.factor(), std::move(D));
  H_above.topRows(model.n_masters) = with_masters(form.right());
  H_above.bottomRows(std::ssize(model.omega)) = linear::inner_product(left_D_, form.right());
  H_ = bordered(H_, H_above, symmetric(linear::inner_product(form.left, form.right())));
  model.K = bordered(model.K, MatrixXd::Zero(model.K.rows(), k), MatrixXd::Identity(k, k));
  modes.Phi = beside(modes.Phi, Z, k);
  left_D_ = beside(left_D_, form.left, k);
  model.omega.resize(model.omega.size() + std::size_t(k), 1.0);
}

void ResidualForms::make_ritz()
{
  ReducedModel& model = of_.model;
  const PetscInt n_m = model.n_masters;
  const auto n_q = static_cast<PetscInt>(model.omega.size());
  const VectorXd unit = stiffness_of_modes(model).cwiseSqrt().cwiseInverse();
  const MatrixXd mass = unit.asDiagonal() * model.M.bottomRightCorner(n_q, n_q) * unit.asDiagonal();
  const linear::SymmetricEigen ritz =  // of M x = mu K x, which keeps the lowest accurate
      linear::symmetric_eigen(mass, petsc::communicator(of_.K.ss));
  std::vector<double> omega;
  MatrixXd V(n_q, n_q);
  for (PetscInt i = n_q - 1; i >= 0 && ritz.values[std::size_t(i)] > 0.0; --i) {
    const double root = std::sqrt(ritz.values[std::size_t(i)]);
    V.col(std::ssize(omega)) = unit.cwiseProduct(ritz.vectors.col(i)) / root;
    omega.push_back(1.0 / root);
  }
  V.conservativeResize(n_q, std::ssize(omega));
  const MatrixXd P = linear::product(V.transpose(), model.M.bottomLeftCorner(n_q, n_m));
  of_.Q_CB.modes = {.Phi = combined(of_.Q_CB.modes->Phi, V), .omega = omega};
  model = join({.K = model.K.topLeftCorner(n_m, n_m), .R = model.R},
               model.M.topLeftCorner(n_m, n_m), P, std::move(omega));
}

}  // namespace chladni::reduce
