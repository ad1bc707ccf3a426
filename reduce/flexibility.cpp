#include "reduce/flexibility.hpp"

#include <petsc/private/matimpl.h>

#include <algorithm>
#include <cmath>

#include "linear/cholesky/cholesky_callbacks.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "reduce/block_rows.hpp"
#include "reduce/held_masters.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The inverse of a K_G on the complement of its r motions without energy, in units that its
/// diagonal gives; all else is as wrong as any, since the forces have no share of it.
MatrixXd pseudo_inverse(const MatrixXd& K_G, Eigen::Index r)
{
  const Eigen::Index n = K_G.rows();
  double largest = 0.0;
  for (PetscInt i = 0; i < n; ++i) largest = std::max(largest, K_G(i, i));
  std::vector<double> scale;
  for (PetscInt i = 0; i < n; ++i) {
    const double k = K_G(i, i) > 0.0 ? K_G(i, i) : largest;
    scale.push_back(k > 0.0 ? 1.0 / std::sqrt(k) : 1.0);
  }
  MatrixXd scaled = K_G;
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i) scaled(i, j) *= scale[i] * scale[j];
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(std::move(scaled));
  MatrixXd V = MatrixXd::Zero(n, n - r);  // of the others, times lambda^(-1/2)
  for (Eigen::Index k = r; k < n; ++k)
    for (PetscInt i = 0; i < n; ++i)
      V(i, k - r) = scale[i] * eigen.vectors(i, k) / std::sqrt(eigen.values[k]);
  return linear::product(V, V.transpose());
}

/// That of the rows that are not held, and zero in the others.
MatrixXd inverse(const MatrixXd& K_G, Eigen::Index r, const std::vector<int>& held)
{
  const std::vector<int> free = all_but(held, K_G.rows());
  MatrixXd inverse = MatrixXd::Zero(K_G.rows(), K_G.cols());
  if (!free.empty()) inverse(free, free) = pseudo_inverse(K_G(free, free), r);
  return inverse;
}

double form(const MatrixXd& G, const MatrixXd& S, PetscInt i, PetscInt j)
{
  double sum = 0.0;
  for (PetscInt b = 0; b < G.cols(); ++b)
    for (PetscInt a = 0; a < G.rows(); ++a) sum += S(a, i) * G(a, b) * S(b, j);
  return sum;
}

/// The combinations S of motions with the mass matrix G that make S^T G S = I.
MatrixXd orthonormal_in(const MatrixXd& G)
{
  constexpr double no_mass = 1e-14;  // of that of the motion before the others are taken out
  MatrixXd S = MatrixXd::Zero(G.rows(), G.cols());
  for (PetscInt j = 0; j < G.cols(); ++j) {
    S(j, j) = 1.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (PetscInt k = 0; k < j; ++k) {
        const double share = form(G, S, k, j);
        for (PetscInt i = 0; i < G.rows(); ++i) S(i, j) -= share * S(i, k);
      }
    }
    const double mass = form(G, S, j, j);
    if (!(mass > no_mass * G(j, j))) {
      throw Error(
          "free-interface modes: a rigid-body motion has no mass; has every part of the body a "
          "density?");
    }
    for (PetscInt i = 0; i < G.rows(); ++i) S(i, j) /= std::sqrt(mass);
  }
  return S;
}

/// Rigid motions of all DOFs, R^T M R = I.
petsc::Matrix rigid_motions(const WholeSystem& body, Mat Psi, const MatrixXd& R_m)
{
  const petsc::Matrix R_s = linear::uninitialized_dense(Psi, R_m.cols());
  petsc::check(MatZeroEntries(R_s));
  linear::add_product(1.0, Psi, R_m, R_s);
  const petsc::Matrix R = linear::uninitialized_dense(body.K, R_m.cols());
  set_rows(R, body.dofs, R_m, R_s);
  petsc::Matrix normal = linear::uninitialized_dense(body.K, R_m.cols());
  petsc::check(MatZeroEntries(normal));
  linear::add_product(
      1.0, R, orthonormal_in(linear::inner_product(R, linear::sparse_product(body.M, R))), normal);
  return normal;
}

}  // namespace

struct Flexibility::Parts {
  const WholeSystem& body;
  Mat Psi;
  Mat R;
  petsc::Matrix MR;
  MatrixXd K_G_inverse;

  /// U = A F.
  void apply(Mat F, Mat U) const
  {
    petsc::Matrix f;
    petsc::check(MatDuplicate(F, MAT_COPY_VALUES, f.put()));
    linear::add_product(-1.0, MR, linear::inner_product(R, f), f);
    const petsc::Matrix f_s = slave_rows(f, body.dofs, body.K_blocks.ss);
    const petsc::Matrix u_s =
        linear::uninitialized_dense(body.K_blocks.ss, linear::LocalRows(f_s).n_cols());
    petsc::check(MatMatSolve(body.K_ss.factor(), f_s, u_s));
    const MatrixXd held = linear::inner_product_sparse(u_s, body.K_blocks.sm);
    const MatrixXd u_m = linear::product(K_G_inverse, master_rows(f, body.dofs) - held.transpose());
    linear::add_product(1.0, Psi, u_m, u_s);
    set_rows(U, body.dofs, u_m, u_s);
    linear::add_product(-1.0, R, linear::inner_product(MR, U), U);
  }
};

Flexibility::Flexibility(const WholeSystem& body, Mat Psi, const GuyanStiffness& K_G,
                         const std::vector<int>& held)
{
  const MatrixXd R_m = at_rest(K_G.R, held);
  R_ = rigid_motions(body, Psi, R_m);
  parts_ = std::make_unique<Parts>(Parts{.body = body,
                                         .Psi = Psi,
                                         .R = R_,
                                         .MR = linear::sparse_product(body.M, R_),
                                         .K_G_inverse = inverse(K_G.K, R_m.cols(), held)});
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(body.K, &n_local, nullptr));
  petsc::check(MatGetSize(body.K, &n, nullptr));
  n_elastic_ = n - static_cast<PetscInt>(std::ssize(held) + R_m.cols());
  petsc::check(MatCreateShell(petsc::communicator(body.K), n_local, n_local, n, n, parts_.get(),
                              factor_.put()));
  PetscErrorCode (*solve)(Mat, Mat, Mat) = [](Mat A, Mat F, Mat U) {
    return linear::guarded([&] {
      const Parts* parts = nullptr;
      petsc::check(MatShellGetContext(A, &parts));
      parts->apply(F, U);
    });
  };
  petsc::check(MatShellSetOperation(factor_, MATOP_MAT_SOLVE, reinterpret_cast<void (*)()>(solve)));
  petsc::check(MatSetUp(factor_));
  static_cast<Mat>(factor_)->factortype =
      MAT_FACTOR_CHOLESKY;  // without which PETSc solves nothing
}

Flexibility::~Flexibility() = default;

}  // namespace chladni::reduce
