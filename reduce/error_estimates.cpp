#include "reduce/error_estimates.hpp"

#include <algorithm>

#include "reduce/progress.hpp"
#include "reduce/sparse_product.hpp"

namespace chladni::reduce {

namespace {

/// Rows first to first + n of a small matrix.
SmallMatrix rows_of(const SmallMatrix& A, PetscInt first, PetscInt n)
{
  SmallMatrix rows(n, A.n_cols);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < n; ++i) rows(i, j) = A(first + i, j);
  }
  return rows;
}

petsc::Matrix zero_block(Mat like, PetscInt n_columns)
{
  PetscInt n_local = 0;
  PetscInt n = 0;
  petsc::check(MatGetLocalSize(like, &n_local, nullptr));
  petsc::check(MatGetSize(like, &n, nullptr));
  petsc::Matrix block;
  petsc::check(MatCreateDense(petsc::communicator(like), n_local, PETSC_DECIDE, n, n_columns,
                              nullptr, block.put()));
  return block;
}

/// r_s = K_ss Phi x_q - lambda (M_ss u_s + M_sm x_m): the constraint modes balance K by themselves,
/// and leaving them out avoids the difference of two large forces.
petsc::Matrix slave_residual(Mat K_ss, const CraigBamptonBasis& Q_CB, const Blocks& M,
                             const ReducedPairs& pairs)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(Q_CB.Psi, nullptr, &n_m));
  const SmallMatrix x_m = rows_of(pairs.X, 0, n_m);
  const SmallMatrix x_q = rows_of(pairs.X, n_m, Q_CB.n_modes());
  petsc::Matrix elastic = zero_block(Q_CB.Psi, pairs.X.n_cols);  // Phi x_q
  if (Q_CB.modes) add_product(1.0, Q_CB.modes->Phi, x_q, elastic);
  petsc::Matrix r = uninitialized_dense(K_ss, pairs.X.n_cols);
  SparseProduct(K_ss).apply(elastic, r);
  add_product(1.0, Q_CB.Psi, x_m, elastic);  // now u_s
  petsc::Matrix inertia = uninitialized_dense(K_ss, pairs.X.n_cols);
  SparseProduct(M.ss).apply(elastic, inertia);
  add_sparse_product(M.sm, x_m, inertia);
  SmallMatrix minus_lambda(pairs.X.n_cols, pairs.X.n_cols);
  for (PetscInt i = 0; i < minus_lambda.n_rows; ++i) minus_lambda(i, i) = -pairs.lambda[i];
  add_product(1.0, inertia, minus_lambda, r);
  return r;
}

ReducedPairs slice(const ReducedPairs& pairs, PetscInt first, PetscInt last)
{
  ReducedPairs some{.X = {pairs.X.n_rows, last - first}, .lambda = {}};
  const auto column = [&](PetscInt j) {
    return pairs.X.values.begin() + std::size_t(j) * pairs.X.n_rows;
  };
  std::copy(column(first), column(last), some.X.values.begin());
  some.lambda.assign(pairs.lambda.begin() + first, pairs.lambda.begin() + last);
  return some;
}

}  // namespace

std::vector<double> error_estimates(const Factorization& K_ss, const CraigBamptonBasis& Q_CB,
                                    const Blocks& M, const ReducedPairs& pairs)
{
  constexpr PetscInt most = 32;  // pairs at a time: bounds the memory
  const auto n_pairs = static_cast<PetscInt>(pairs.lambda.size());
  std::vector<double> eta2;
  for (PetscInt first = 0; first < n_pairs; first += most) {
    report_progress(double(first) / n_pairs);
    const ReducedPairs some = slice(pairs, first, std::min(first + most, n_pairs));
    const petsc::Matrix r = slave_residual(K_ss.matrix(), Q_CB, M, some);
    const petsc::Matrix z = uninitialized_dense(K_ss.matrix(), some.X.n_cols);
    petsc::check(MatMatSolve(K_ss.factor(), r, z));
    const SmallMatrix r_z = inner_product(r, z);
    for (PetscInt i = 0; i < r_z.n_rows; ++i) {
      eta2.push_back(std::max(0.0, r_z(i, i)) / some.lambda[i]);
    }
  }
  return eta2;
}

double frequency_error(double eta2, double lambda, double lambda_left_out)
{
  constexpr double least = 0.02;  // close to the modes left out nothing is known
  return 0.5 * eta2 / std::max(least, 1.0 - lambda / lambda_left_out);
}

}  // namespace chladni::reduce
