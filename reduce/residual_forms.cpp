#include "reduce/residual_forms.hpp"

#include <algorithm>
#include <cmath>

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
  const MatrixXd H_mm = forms_of_masters();
  const petsc::Matrix D = linear::sparse_product(of_.M.ss, of_.Q_CB.modes->Phi);
  z_D_ = solved(of_.K_ss.factor(), D);
  H_ = bordered(H_mm, linear::inner_product(z_B_, D), symmetric(linear::inner_product(z_D_, D)));
}

MatrixXd ResidualForms::forms_of_masters()
{
  constexpr PetscInt most = 64;  // columns of B at a time
  const Mat Psi = of_.Q_CB.Psi;
  const PetscInt n_m = linear::LocalRows(Psi).n_cols();
  z_B_ = linear::uninitialized_dense(of_.K.ss, n_m);
  petsc::check(MatZeroEntries(z_B_));
  const MatrixXd unit = MatrixXd::Identity(n_m, n_m);
  MatrixXd H = MatrixXd::Zero(n_m, n_m);
  for (PetscInt first = 0; first < n_m; first += most) {
    const PetscInt last = std::min(first + most, n_m);
    const petsc::Matrix B = linear::sparse_product(of_.M.ss, linear::ColumnRange(Psi, first, last));
    linear::add_sparse_product(of_.M.sm, unit.middleCols(first, last - first), B);
    const petsc::Matrix z = solved(of_.K_ss.factor(), B);
    petsc::check(MatCopy(z, linear::ColumnRange(z_B_, first, last), SAME_NONZERO_PATTERN));
    H.block(0, first, last, last - first) =
        linear::inner_product(linear::ColumnRange(z_B_, 0, last), B);
  }
  return H.selfadjointView<Eigen::Upper>();
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
  linear::add_product(-s, z_B_, X_m, z);
  linear::add_product(-s, z_D_, X_q, z);
  return z;
}

void ResidualForms::append(Mat shapes)
{
  ReducedModel& model = of_.model;
  FixedInterfaceModes& modes = *of_.Q_CB.modes;
  const petsc::Matrix Z = orthonormal(shapes, modes.Phi, stiffness_of_modes(model), of_.K.ss);
  const PetscInt k = linear::LocalRows(Z).n_cols();
  const petsc::Matrix D = linear::sparse_product(of_.M.ss, Z), z = solved(of_.K_ss.factor(), D);
  MatrixXd above(model.M.rows(), k), H_above(H_.rows(), k);
  above.topRows(model.n_masters) = linear::inner_product(of_.Q_CB.Psi, D) +
                                   linear::inner_product_sparse(Z, of_.M.sm).transpose();
  above.bottomRows(std::ssize(model.omega)) = linear::inner_product(modes.Phi, D);
  H_above.topRows(model.n_masters) = linear::inner_product(z_B_, D);
  H_above.bottomRows(std::ssize(model.omega)) = linear::inner_product(z_D_, D);
  H_ = bordered(H_, H_above, symmetric(linear::inner_product(z, D)));
  model.M = bordered(model.M, above, symmetric(linear::inner_product(Z, D)));
  model.K = bordered(model.K, MatrixXd::Zero(model.K.rows(), k), MatrixXd::Identity(k, k));
  modes.Phi = beside(modes.Phi, Z, k);
  z_D_ = beside(z_D_, z, k);
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
