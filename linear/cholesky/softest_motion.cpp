#include "linear/cholesky/softest_motion.hpp"

#include <cmath>
#include <limits>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/diagonal.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::linear {

namespace {

constexpr PetscInt n_vectors = 4;

/// Values without any regularity over the rows, the same for any number of ranks.
void fill(Mat Z)
{
  PetscScalar* values = nullptr;
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(Z, &first, &last));
  petsc::check(MatDenseGetArrayWrite(Z, &values));
  for (PetscInt j = 0; j < n_vectors; ++j)
    for (PetscInt i = first; i < last; ++i)
      values[i - first + std::size_t(j) * (last - first)] = std::sin(1.0 + (j + 1.3) * i) + 0.5;
  petsc::check(MatDenseRestoreArrayWrite(Z, &values));
}

/// Largest component of column j, in the lengths that the diagonal d gives.
PetscInt largest_row(Mat Z, PetscInt j, Vec d)
{
  petsc::Vector z;
  Vec column = nullptr;
  PetscInt row = 0;
  petsc::check(VecDuplicate(d, z.put()));
  petsc::check(VecCopy(d, z));
  petsc::check(VecSqrtAbs(z));
  petsc::check(MatDenseGetColumnVecRead(Z, j, &column));
  petsc::check(VecPointwiseMult(z, z, column));
  petsc::check(MatDenseRestoreColumnVecRead(Z, j, &column));
  petsc::check(VecAbs(z));
  PetscReal largest = 0.0;
  petsc::check(VecMax(z, &row, &largest));
  return row;
}

}  // namespace

SoftestMotion softest_motion(Mat factor, Mat A)
{
  const petsc::Vector d = diagonal(A);
  const petsc::Matrix Z = uninitialized_dense(A, n_vectors);
  const petsc::Matrix DZ = uninitialized_dense(A, n_vectors);
  const petsc::Matrix AZ = uninitialized_dense(A, n_vectors);
  fill(Z);
  for (int iteration = 0; iteration < 2; ++iteration) {
    petsc::check(MatCopy(Z, DZ, SAME_NONZERO_PATTERN));
    petsc::check(MatDiagonalScale(DZ, d, nullptr));
    petsc::check(MatMatSolve(factor, DZ, Z));
    PetscReal norm = 0.0;
    petsc::check(MatNorm(Z, NORM_FROBENIUS, &norm));
    petsc::check(MatScale(Z, 1.0 / norm));
  }
  SparseProduct(A).apply(Z, AZ);
  petsc::check(MatCopy(Z, DZ, SAME_NONZERO_PATTERN));
  petsc::check(MatDiagonalScale(DZ, d, nullptr));
  const Eigen::MatrixXd Z_AZ = inner_product(Z, AZ), Z_DZ = inner_product(Z, DZ);
  SoftestMotion softest{.stiffness = std::numeric_limits<double>::infinity(), .row = 0};
  for (PetscInt j = 0; j < n_vectors; ++j) {
    const double stiffness = std::abs(Z_AZ(j, j)) / Z_DZ(j, j);
    if (stiffness < softest.stiffness) softest = {.stiffness = stiffness, .row = j};
  }
  softest.row = largest_row(Z, softest.row, d);
  return softest;
}

}  // namespace chladni::linear
