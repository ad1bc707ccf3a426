#include "reduce/project_form.hpp"

#include <vector>

#include "linear/kernels/small_matrices.hpp"
#include "reduce/basis_rows.hpp"

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

}  // namespace

/// With Q_CB = [I 0; X], X = [Psi Phi]: A_r = A_mm + A_ms X + X^T A_sm + X^T A_ss X.
MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A, linear::FormSymmetry symmetry)
{
  const MatrixXd A_mm = linear::replicate(A.mm);
  const auto n_m = static_cast<PetscInt>(A_mm.rows());
  std::vector<Columns> X{{Q_CB.Psi, 0}};
  if (Q_CB.modes) X.push_back({Q_CB.modes->Phi, n_m});
  MatrixXd A_r = MatrixXd::Zero(n_m + Q_CB.n_modes(), n_m + Q_CB.n_modes());
  add_block(A_r, 0, 0, A_mm);
  petsc::Matrix A_ms_T;  // that its product with X is one with sparse columns
  petsc::check(MatTranspose(A.ms, MAT_INITIAL_MATRIX, A_ms_T.put()));
  for (const Columns& part : X) {
    add_block(A_r, part.first, 0, linear::inner_product_sparse(part.X, A.sm));
    add_block(A_r, 0, part.first, linear::inner_product_sparse(part.X, A_ms_T).transpose());
  }
  std::vector<Mat> columns;
  for (const Columns& part : X) columns.push_back(part.X);
  return A_r + linear::parted_form(columns, A.ss, symmetry);
}

std::vector<MatrixXd> project_forms(const CraigBamptonBasis& Q_CB, const DofPartition& dofs,
                                    std::span<const linear::SparseForm> forms)
{
  const BasisColumns columns(Q_CB, dofs);
  const auto write = [&](PetscInt j, std::span<double> rows) { columns.write(j, rows); };
  return linear::component_forms({.n_columns = columns.size(), .write = write}, forms);
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
