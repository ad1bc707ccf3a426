#include "reduce/block_rows.hpp"

#include <vector>

#include "common/index_sets.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The rows of a set that this rank holds, counted from the first row of X.
struct OwnRows {
  std::vector<PetscInt> rows;
  PetscInt before;  ///< rows of the set on the ranks before
  PetscInt n_all = 0;

  OwnRows(Mat X, IS set) : rows(petsc::own_rows(set, X)), before(petsc::indices_before(set))
  {
    petsc::check(ISGetSize(set, &n_all));
  }
  PetscInt size() const { return static_cast<PetscInt>(rows.size()); }
};

}  // namespace

petsc::Matrix slave_rows(Mat X, const DofPartition& dofs, Mat like)
{
  const OwnRows slaves(X, dofs.slaves);
  const linear::LocalRows x(X);
  petsc::Matrix X_s = linear::uninitialized_dense(like, x.n_cols());
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X_s, &values));
  for (PetscInt j = 0; j < x.n_cols(); ++j)
    for (PetscInt i = 0; i < slaves.size(); ++i)
      values[i + std::size_t(j) * slaves.size()] = x(slaves.rows[i], j);
  petsc::check(MatDenseRestoreArrayWrite(X_s, &values));
  return X_s;
}

MatrixXd master_rows(Mat X, const DofPartition& dofs)
{
  const OwnRows masters(X, dofs.masters);
  MatrixXd X_m = MatrixXd::Zero(masters.n_all, linear::LocalRows(X).n_cols());
  {
    const linear::LocalRows x(X);
    for (PetscInt j = 0; j < x.n_cols(); ++j)
      for (PetscInt i = 0; i < masters.size(); ++i)
        X_m(masters.before + i, j) = x(masters.rows[i], j);
  }
  linear::sum_over_ranks(linear::values_of(X_m), petsc::communicator(X));
  return X_m;
}

petsc::Matrix block_of(const linear::LocalRows& X, const std::vector<PetscInt>& rows,
                       std::span<const int> columns, Mat like)
{
  petsc::Matrix block = linear::uninitialized_dense(like, std::ssize(columns));
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(block, &values));
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      values[i + j * rows.size()] = X(rows[i], columns[j]);
  petsc::check(MatDenseRestoreArrayWrite(block, &values));
  return block;
}

void set_rows(Mat X, const DofPartition& dofs, const MatrixXd& X_m, Mat X_s)
{
  const OwnRows masters(X, dofs.masters), slaves(X, dofs.slaves);
  const linear::LocalRows x_s(X_s);
  PetscScalar* values = nullptr;
  PetscInt ld = 0;
  petsc::check(MatDenseGetLDA(X, &ld));
  petsc::check(MatDenseGetArray(X, &values));
  for (PetscInt j = 0; j < x_s.n_cols(); ++j) {
    PetscScalar* column = values + std::size_t(j) * ld;
    for (PetscInt i = 0; i < slaves.size(); ++i) column[slaves.rows[i]] = x_s(i, j);
    for (PetscInt i = 0; i < masters.size(); ++i)
      column[masters.rows[i]] = X_m(masters.before + i, j);
  }
  petsc::check(MatDenseRestoreArray(X, &values));
}

petsc::Matrix beside(Mat R, Mat X, PetscInt k)
{
  const PetscInt r = linear::LocalRows(R).n_cols();
  petsc::Matrix both = linear::uninitialized_dense(R, r + k);
  if (r > 0) petsc::check(MatCopy(R, linear::ColumnRange(both, 0, r), SAME_NONZERO_PATTERN));
  if (k > 0) {
    petsc::check(MatCopy(linear::ColumnRange(X, 0, k), linear::ColumnRange(both, r, r + k),
                         SAME_NONZERO_PATTERN));
  }
  return both;
}

}  // namespace chladni::reduce
