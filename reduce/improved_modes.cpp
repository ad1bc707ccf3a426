#include "reduce/improved_modes.hpp"

#include <cmath>

#include "common/index_sets.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/shifted.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::reduce {
namespace {

using Eigen::Index, Eigen::MatrixXd;

petsc::Matrix free_block(Mat A, const FreeDofs& free)
{
  petsc::Matrix block;
  petsc::check(MatCreateSubMatrix(A, free.indices, free.indices, MAT_INITIAL_MATRIX, block.put()));
  return block;
}

/// The free rows of the shapes.
petsc::Matrix free_rows(const ShapesNearModes& shapes, const FreeDofs& free, Mat K_ff)
{
  const MatrixXd rows = shapes.rows(petsc::own_indices(free.indices));
  petsc::Matrix X = linear::uninitialized_dense(K_ff, shapes.n_shapes);
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArrayWrite(X, &values));
  std::copy_n(rows.data(), rows.size(), values);
  petsc::check(MatDenseRestoreArrayWrite(X, &values));
  return X;
}

}  // namespace

ImprovedModes improved_modes(Mat K, Mat M, const FreeDofs& free, const ShapesNearModes& shapes,
                             double mu, const linear::SolverOptions& options)
{
  petsc::Matrix A = free_block(K, free);
  const petsc::Matrix M_ff = free_block(M, free);
  if (mu != 0.0) A = linear::shifted(A, M_ff, -mu);
  const linear::Factorization factor = linear::factorize(A, options);
  const petsc::Matrix MX = linear::sparse_product(M_ff, free_rows(shapes, free, A));
  const petsc::Matrix Y = linear::uninitialized_dense(A, shapes.n_shapes);
  petsc::check(MatMatSolve(factor.factor(), MX, Y));
  MatrixXd K_r = linear::inner_product(Y, MX);
  MatrixXd M_r = linear::inner_product(Y, linear::sparse_product(M_ff, Y));
  const Eigen::VectorXd scale = M_r.diagonal().cwiseSqrt().cwiseInverse();
  M_r = scale.asDiagonal() * M_r * scale.asDiagonal();
  K_r = scale.asDiagonal() * K_r * scale.asDiagonal();
  K_r = MatrixXd(0.5 * (K_r + K_r.transpose()));
  M_r = MatrixXd(0.5 * (M_r + M_r.transpose()));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> pairs(K_r, M_r);
  petsc::Matrix X = linear::uninitialized_dense(A, shapes.n_shapes);
  petsc::check(MatZeroEntries(X));
  linear::add_product(1.0, Y, scale.asDiagonal() * pairs.eigenvectors(), X);
  return {.lambda = (pairs.eigenvalues().array() - mu).matrix(),
          .shares = pairs.eigenvectors().cwiseAbs2(),
          .X = std::move(X)};
}

}  // namespace chladni::reduce
