#include "reduce/project_form.hpp"

#include <vector>

#include "linear/kernels/basis_forms.hpp"
#include "linear/kernels/small_matrices.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

void add_block(MatrixXd& A, Eigen::Index first_row, Eigen::Index first_column,
               const MatrixXd& block)
{
  A.block(first_row, first_column, block.rows(), block.cols()) += block;
}

/// A dense basis of the slaves and its first coordinate.
struct Columns {
  Mat X;
  PetscInt first;
};

std::vector<Columns> columns_of(const CraigBamptonBasis& Q_CB, PetscInt n_m)
{
  std::vector<Columns> X{{Q_CB.Psi, 0}};
  if (Q_CB.modes) X.push_back({Q_CB.modes->Phi, n_m});
  return X;
}

/// A_mm + A_ms X + X^T A_sm
MatrixXd form_of_masters(const CraigBamptonBasis& Q_CB, const Blocks& A)
{
  const MatrixXd A_mm = linear::replicate(A.mm);
  MatrixXd A_r = MatrixXd::Zero(A_mm.rows() + Q_CB.n_modes(), A_mm.rows() + Q_CB.n_modes());
  add_block(A_r, 0, 0, A_mm);
  petsc::Matrix A_ms_T;  // that its product with X is one with sparse columns
  petsc::check(MatTranspose(A.ms, MAT_INITIAL_MATRIX, A_ms_T.put()));
  for (const auto& [X, first] : columns_of(Q_CB, static_cast<PetscInt>(A_mm.rows()))) {
    add_block(A_r, first, 0, linear::inner_product_sparse(X, A.sm));
    add_block(A_r, 0, first, linear::inner_product_sparse(X, A_ms_T).transpose());
  }
  return A_r;
}

std::vector<Mat> matrices_of(const CraigBamptonBasis& Q_CB)
{
  std::vector<Mat> X;
  for (const Columns& some : columns_of(Q_CB, 0)) X.push_back(some.X);
  return X;
}

}  // namespace

/// With Q_CB = [I 0; X], X = [Psi Phi]: A_r = A_mm + A_ms X + X^T A_sm + X^T A_ss X.
MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A, linear::FormSymmetry symmetry)
{
  return form_of_masters(Q_CB, A) + linear::parted_form(matrices_of(Q_CB), A.ss, symmetry);
}

std::vector<MatrixXd> project_forms(const CraigBamptonBasis& Q_CB, Mat K_ss,
                                    std::span<const FormBlocks> forms)
{
  std::vector<linear::SparseForm> of_slaves;
  for (const auto& [A, symmetry] : forms) of_slaves.push_back({.A = A.ss, .symmetry = symmetry});
  std::vector<MatrixXd> projected = linear::basis_forms(matrices_of(Q_CB), K_ss, of_slaves);
  for (std::size_t f = 0; f < forms.size(); ++f) projected[f] += form_of_masters(Q_CB, forms[f].A);
  return projected;
}

MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V)
{
  petsc::Matrix V_m, V_s;
  petsc::check(MatCreateSubMatrix(V, dofs.masters, nullptr, MAT_INITIAL_MATRIX, V_m.put()));
  petsc::check(MatCreateSubMatrix(V, dofs.slaves, nullptr, MAT_INITIAL_MATRIX, V_s.put()));
  const MatrixXd V_mm = linear::replicate(V_m);
  const MatrixXd Psi_V = linear::inner_product(Q_CB.Psi, V_s);
  if (!Q_CB.modes) return V_mm + Psi_V;
  return linear::stacked(V_mm + Psi_V, linear::inner_product(Q_CB.modes->Phi, V_s));
}

}  // namespace chladni::reduce
