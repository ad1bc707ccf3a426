#include "reduce/project_form.hpp"

#include <algorithm>

#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"

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

constexpr PetscInt block_columns = 64;  // of A_ss X at a time: bounds the memory

/// Rows of this rank that have entries, counted from its first.
std::vector<PetscInt> rows_with_entries(Mat A)
{
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  std::vector<PetscInt> rows;
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt n = 0;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(A, row, &n, nullptr, &values));
    if (std::any_of(values, values + n, [](double value) { return value != 0.0; }))
      rows.push_back(row - begin);
    petsc::check(MatRestoreRow(A, row, &n, nullptr, &values));
  }
  return rows;
}

/// These rows of a dense matrix.
petsc::Matrix take_rows(Mat X, const std::vector<PetscInt>& rows)
{
  PetscInt n_columns = 0, lda = 0, lda_taken = 0;
  petsc::check(MatGetSize(X, nullptr, &n_columns));
  petsc::Matrix taken;
  petsc::check(MatCreateDense(petsc::communicator(X), static_cast<PetscInt>(rows.size()),
                              PETSC_DECIDE, PETSC_DETERMINE, n_columns, nullptr, taken.put()));
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  petsc::check(MatDenseGetLDA(X, &lda));
  petsc::check(MatDenseGetLDA(taken, &lda_taken));
  petsc::check(MatDenseGetArrayRead(X, &from));
  petsc::check(MatDenseGetArrayWrite(taken, &to));
  for (PetscInt j = 0; j < n_columns; ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      to[std::ptrdiff_t(j) * lda_taken + std::ptrdiff_t(i)] =
          from[std::ptrdiff_t(j) * lda + rows[i]];
    }
  }
  petsc::check(MatDenseRestoreArrayWrite(taken, &to));
  petsc::check(MatDenseRestoreArrayRead(X, &from));
  return taken;
}

/// Adds X^T A_ss X. What has displacements in one direction alone leaves most rows empty: these do
/// not take part in the products of dense matrices, where the time goes.
void add_slaves(MatrixXd& A_r, const std::vector<Columns>& X, Mat A_ss)
{
  const linear::SparseProduct product(A_ss);
  const std::vector<PetscInt> rows = rows_with_entries(A_ss);
  std::vector<petsc::Matrix> left;
  for (const Columns& part : X) left.push_back(take_rows(part.X, rows));
  for (const Columns& right : X) {
    PetscInt n = 0;
    petsc::check(MatGetSize(right.X, nullptr, &n));
    for (PetscInt first = 0; first < n; first += block_columns) {
      const PetscInt last = std::min(first + block_columns, n);
      const petsc::Matrix A_X = linear::uninitialized_dense(A_ss, last - first);
      product.apply(linear::ColumnRange(right.X, first, last), A_X);
      const petsc::Matrix taken = take_rows(A_X, rows);
      for (std::size_t i = 0; i < X.size(); ++i)
        add_block(A_r, X[i].first, right.first + first, linear::inner_product(left[i], taken));
    }
  }
}

}  // namespace

/// With Q_CB = [I 0; X], X = [Psi Phi]: A_r = A_mm + A_ms X + X^T A_sm + X^T A_ss X.
MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A)
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
  add_slaves(A_r, X, A.ss);
  return A_r;
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
