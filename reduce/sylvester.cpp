#include "reduce/sylvester.hpp"

#include <algorithm>

#include "reduce/quiet_mumps.hpp"

namespace chladni::reduce {

namespace {

/// Own rows that are not held.
petsc::IndexSet free_rows(Mat K, std::vector<PetscInt> held)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::ranges::sort(held);
  std::vector<PetscInt> rows;
  for (PetscInt i = first; i < last; ++i) {
    if (!std::ranges::binary_search(held, i)) rows.push_back(i);
  }
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(petsc::communicator(K), static_cast<PetscInt>(rows.size()),
                               rows.data(), PETSC_COPY_VALUES, set.put()));
  return set;
}

petsc::Matrix submatrix(Mat A, IS rows)
{
  petsc::Matrix block;
  petsc::check(MatCreateSubMatrix(A, rows, rows, MAT_INITIAL_MATRIX, block.put()));
  return block;
}

}  // namespace

petsc::Matrix shifted(Mat K, Mat M, double sigma)
{
  petsc::Matrix A;
  petsc::check(MatDuplicate(K, MAT_COPY_VALUES, A.put()));
  petsc::check(MatAXPY(A, -sigma, M, DIFFERENT_NONZERO_PATTERN));
  petsc::check(MatSetOption(A, MAT_SPD, PETSC_FALSE));  // K_ss is marked definite, A is not
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

PetscInt eigenvalues_below(Mat K, Mat M, double sigma)
{
  const petsc::Matrix A = shifted(K, M, sigma);
  petsc::LinearSolver solver;
  PC pc = nullptr;
  Mat factor = nullptr;
  petsc::check(KSPCreate(petsc::communicator(K), solver.put()));
  petsc::check(KSPSetOptionsPrefix(solver, "cms_sylvester_"));
  petsc::check(KSPSetOperators(solver, A, A));
  petsc::check(KSPSetType(solver, KSPPREONLY));
  petsc::check(KSPGetPC(solver, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  petsc::check(KSPSetFromOptions(solver));
  quiet_mumps(pc);
  petsc::check(KSPSetUp(solver));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  if (error != MAT_FACTOR_NOERROR) {
    PetscInt code = 0;
    petsc::check(MatMumpsGetInfog(factor, 1, &code));
    throw Error(
        fmt::format("eigenvalues_below: K - sigma M has no factor at sigma = {:.15g} (MUMPS: "
                    "INFOG(1) = {}); sigma is an eigenvalue, or the memory does not suffice",
                    sigma, code));
  }
  PetscInt negative = 0;
  petsc::check(MatMumpsGetInfog(factor, 12, &negative));
  return negative;
}

PetscInt eigenvalues_below(Mat K, Mat M, double sigma, const std::vector<PetscInt>& held)
{
  if (held.empty()) return eigenvalues_below(K, M, sigma);
  const petsc::IndexSet rows = free_rows(K, held);
  return eigenvalues_below(submatrix(K, rows), submatrix(M, rows), sigma);
}

}  // namespace chladni::reduce
