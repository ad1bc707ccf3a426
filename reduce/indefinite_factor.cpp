#include "reduce/indefinite_factor.hpp"

#include "linear/cholesky/inner_solver.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::reduce {
namespace {

/// Largest |A v - e| over |A| |v| of the columns in the Frobenius norm.
double backward_error(Mat A, Mat V, Mat E)
{
  petsc::Matrix R = linear::uninitialized_dense(A, linear::LocalRows(V).n_cols());
  linear::SparseProduct(A).apply(V, R);
  petsc::check(MatAXPY(R, -1.0, E, SAME_NONZERO_PATTERN));
  double residual = 0.0, of_A = 0.0, of_V = 0.0;
  petsc::check(MatNorm(R, NORM_FROBENIUS, &residual));
  petsc::check(MatNorm(A, NORM_FROBENIUS, &of_A));
  petsc::check(MatNorm(V, NORM_FROBENIUS, &of_V));
  return residual / (of_A * of_V);
}

}  // namespace

petsc::LinearSolver indefinite_factor(Mat A, const linear::OptionSource& source)
{
  petsc::LinearSolver solver = linear::new_solver(petsc::communicator(A), source);
  PC pc = nullptr;
  petsc::check(KSPSetOperators(solver, A, A));
  petsc::check(KSPSetType(solver, KSPPREONLY));
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(KSPSetFromOptions(solver));
  linear::set_up_factor(pc, source);
  petsc::check(KSPSetUp(solver));
  return solver;
}

bool solve_to_round_off(KSP solver, Mat E, Mat V)
{
  PC pc = nullptr;
  Mat factor = nullptr, A = nullptr;
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  petsc::check(KSPGetOperators(solver, &A, nullptr));
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  petsc::check(MatZeroEntries(V));
  if (error != MAT_FACTOR_NOERROR) return false;
  petsc::check(MatMatSolve(factor, E, V));
  constexpr double round_off = 1e-12;
  return backward_error(A, V, E) < round_off;
}

}  // namespace chladni::reduce
