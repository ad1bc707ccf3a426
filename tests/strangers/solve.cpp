#include "solve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::strangers {

namespace {

petsc::Matrix matrix(const std::vector<Entry>& entries, int n, MPI_Comm comm)
{
  petsc::Matrix A;
  PetscInt first = 0, last = 0;
  petsc::check(
      MatCreateAIJ(comm, PETSC_DECIDE, PETSC_DECIDE, n, n, 0, nullptr, 0, nullptr, A.put()));
  petsc::check(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (const Entry& a : entries) {
    if (a.row < first || a.row >= last) continue;
    petsc::check(MatSetValue(A, a.row, a.column, a.value, ADD_VALUES));
  }
  petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

/// All of them on the first rank: the class finds the owners.
petsc::IndexSet interface(const std::vector<int>& masters, MPI_Comm comm)
{
  const std::vector<PetscInt> all(masters.begin(), masters.end());
  const auto n = petsc::rank(comm) == 0 ? static_cast<PetscInt>(all.size()) : 0;
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(comm, n, all.data(), PETSC_COPY_VALUES, set.put()));
  return set;
}

std::string message_of(PetscErrorCode code)
{
  const char* specific = petsc::error_texts(PetscErrorMessage, code).specific;
  std::string message = specific != nullptr ? specific : "";
  std::ranges::replace(message, '\n', ' ');
  return message;
}

}  // namespace

PetscErrorCode set(CMS cms, const Reduction& how)
{
  PetscFunctionBegin;
  PetscCall(CMSSetType(cms, how.type));
  PetscCall(CMSSetSylvester(cms, PETSC_TRUE));
  if (how.modes > 0)
    PetscCall(CMSSetDimensions(cms, how.modes));
  else if (how.cutoff_Hz > 0.0)
    PetscCall(CMSSetCutoff(cms, how.cutoff_Hz));
  else if (how.tolerance > 0.0)
    PetscCall(CMSSetTolerance(cms, how.tolerance, how.up_to_Hz));
  PetscFunctionReturn(0);
}

namespace {

template <class Get>
std::vector<double> values(CMS cms, const Get& get)
{
  PetscInt n = 0;
  const PetscReal* first = nullptr;
  petsc::check(get(cms, &n, &first));
  return {first, first + n};
}

void read(CMS cms, Answer& answer)
{
  PetscInt n_masters = 0, n_modes = 0;
  Mat K_r = nullptr, M_r = nullptr, T = nullptr;
  petsc::check(CMSGetDimensions(cms, &n_masters, &n_modes));
  petsc::check(CMSGetReducedOperators(cms, &K_r, &M_r, nullptr));
  petsc::check(CMSGetTransformation(cms, &T));
  answer.n_masters = static_cast<int>(n_masters);
  answer.n_modes = static_cast<int>(n_modes);
  answer.K_r = linear::replicate(K_r);
  answer.M_r = linear::replicate(M_r);
  answer.T = linear::replicate(T);
  answer.lambda = values(cms, CMSGetFrequencies);
  for (double& f : answer.lambda) f = std::pow(2.0 * std::numbers::pi * f, 2);
  answer.eta2 = values(cms, CMSGetErrors);
  answer.rounding = values(cms, CMSGetRounding);
  answer.bounds = values(cms, CMSGetErrorBounds);
  petsc::check(CMSGetQuality(cms, &answer.quality));
}

/// Owns an object of the class CMS.
using Solver = petsc::Owned<CMS, CMSDestroy>;

}  // namespace

namespace {

Rows shuffled(const std::vector<Entry>& entries, int n)
{
  std::vector<std::vector<std::pair<PetscInt, double>>> rows(static_cast<std::size_t>(n));
  for (const Entry& a : entries) {
    auto& row = rows[static_cast<std::size_t>(a.row)];
    row.emplace_back(a.column, 0.375 * a.value);
    row.insert(row.begin(), {a.column, 0.625 * a.value});
  }
  Rows all{.first = {0}, .column = {}, .value = {}};
  for (auto& row : rows) {
    std::ranges::sort(row, {}, [](const auto& entry) { return std::sin(1e3 * entry.second); });
    for (const auto& [column, value] : row) {
      all.column.push_back(column);
      all.value.push_back(value);
    }
    all.first.push_back(static_cast<PetscInt>(all.column.size()));
  }
  return all;
}

petsc::Matrix matrix_on(Rows& rows)
{
  petsc::Matrix A;
  const auto n = static_cast<PetscInt>(rows.first.size()) - 1;
  petsc::check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, rows.first.data(),
                                         rows.column.data(), rows.value.data(), A.put()));
  return A;
}

}  // namespace

Operators operators(const Pencil& pencil, MPI_Comm comm)
{
  return {.K = matrix(pencil.K, pencil.n, comm), .M = matrix(pencil.M, pencil.n, comm)};
}

Operators shuffled_operators(const Pencil& pencil)
{
  Operators A{.of_K = shuffled(pencil.K, pencil.n), .of_M = shuffled(pencil.M, pencil.n)};
  A.K = matrix_on(A.of_K);
  A.M = matrix_on(A.of_M);
  return A;
}

Answer reduce(const Pencil& pencil, const Reduction& how, MPI_Comm comm)
{
  const bool is_shuffled = how.is_shuffled && petsc::size(comm) == 1;
  const Operators A = is_shuffled ? shuffled_operators(pencil) : operators(pencil, comm);
  const petsc::IndexSet masters = interface(pencil.masters, comm);
  const petsc::IndexSet held = interface(pencil.held, comm);
  Solver cms;
  Answer answer;
  petsc::check(CMSCreate(comm, cms.put()));
  answer.code = set(cms, how);
  if (!answer.code) answer.code = CMSSetOperators(cms, A.K, A.M, nullptr);
  if (!answer.code) answer.code = CMSSetInterface(cms, masters);
  if (!answer.code && !pencil.held.empty()) answer.code = CMSSetHeld(cms, held);
  if (!answer.code) answer.code = CMSSolve(cms);
  return answer_of(cms, answer.code);
}

Answer answer_of(CMS cms, PetscErrorCode code)
{
  Answer answer;
  answer.code = code;
  if (code)
    answer.message = message_of(code);
  else
    read(cms, answer);
  return answer;
}

namespace {

/// The problem with the factor of MUMPS, which several ranks can make.
PetscErrorCode solve(EPS eps, const Operators& A, int n, double target)
{
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  PetscFunctionBegin;
  PetscCall(EPSSetOperators(eps, A.K, A.M));
  PetscCall(EPSSetProblemType(eps, EPS_GHEP));
  PetscCall(EPSSetType(eps, "blocklanczos"));
  PetscCall(EPSSetDimensions(eps, n, petsc::automatic, petsc::automatic));
  PetscCall(EPSSetTarget(eps, target));
  PetscCall(EPSSetTolerances(eps, 1e-10, petsc::automatic));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  PetscCall(EPSGetST(eps, &st));
  PetscCall(STSetType(st, STSINVERT));
  PetscCall(STSetShift(st, target));
  PetscCall(STGetKSP(st, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(EPSSetFromOptions(eps));
  PetscCall(EPSSolve(eps));
  PetscFunctionReturn(0);
}

void read(EPS eps, const Operators& A, Eigenpairs& pairs)
{
  PetscInt n = 0;
  PetscReal norm_K = 0.0, norm_M = 0.0;
  petsc::Vector x, y, z;
  petsc::check(EPSGetConverged(eps, &n));
  petsc::check(MatNorm(A.K, NORM_FROBENIUS, &norm_K));
  petsc::check(MatNorm(A.M, NORM_FROBENIUS, &norm_M));
  petsc::check(MatCreateVecs(A.K, x.put(), y.put()));
  petsc::check(VecDuplicate(x, z.put()));
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar lambda = 0.0;
    PetscReal norm_x = 0.0, residual = 0.0;
    petsc::check(EPSGetEigenpair(eps, i, &lambda, nullptr, x, nullptr));
    petsc::check(MatMult(A.K, x, y));
    petsc::check(MatMult(A.M, x, z));
    petsc::check(VecAXPY(y, -lambda, z));
    petsc::check(VecNorm(y, NORM_2, &residual));
    petsc::check(VecNorm(x, NORM_2, &norm_x));
    pairs.lambda.push_back(lambda);
    pairs.residual.push_back(residual / ((norm_K + std::abs(lambda) * norm_M) * norm_x));
  }
}

}  // namespace

Eigenpairs eigenpairs(const Pencil& pencil, int n, double target, MPI_Comm comm)
{
  const Operators A = operators(pencil, comm);
  petsc::EigenSolver eps;
  Eigenpairs pairs;
  petsc::check(EPSCreate(comm, eps.put()));
  pairs.code = solve(eps, A, n, target);
  if (pairs.code)
    pairs.message = message_of(pairs.code);
  else
    read(eps, A, pairs);
  return pairs;
}

}  // namespace chladni::strangers
