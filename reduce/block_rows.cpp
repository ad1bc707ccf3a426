#include "reduce/block_rows.hpp"

#include <vector>

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// The rows of a set that this rank holds, counted from the first row of X.
struct OwnRows {
  std::vector<PetscInt> rows;
  PetscInt before;  ///< rows of the set on the ranks before
  PetscInt n_all;

  OwnRows(Mat X, IS set)
  {
    PetscInt first = 0, n = 0;
    const PetscInt* indices = nullptr;
    petsc::check(MatGetOwnershipRange(X, &first, nullptr));
    petsc::check(ISGetLocalSize(set, &n));
    petsc::check(ISGetSize(set, &n_all));
    petsc::check(ISGetIndices(set, &indices));
    for (PetscInt i = 0; i < n; ++i) rows.push_back(indices[i] - first);
    petsc::check(ISRestoreIndices(set, &indices));
    const MPI_Comm comm = petsc::communicator(X);
    before = 0;
    MPI_Exscan(&n, &before, 1, MPIU_INT, MPI_SUM, comm);
    if (petsc::rank(comm) == 0) before = 0;
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
