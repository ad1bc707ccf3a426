// Programs of the kinds that come with SLEPc, written anew for the solver type "blocklanczos": the
// values of each are those of LAPACK, with all copies, and their errors meet the tolerance; or the
// program is refused with a reason.
#include <chladni_cms.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::plugin {
namespace {

using linear::testing::diagonal, linear::testing::matrix, linear::testing::Row;

petsc::Matrix chain_of(PetscInt n, double diagonal_value = 2.0, double beside = -1.0)
{
  return matrix(n, 3, [=](PetscInt i) {
    Row row{{i, diagonal_value}};
    if (i > 0) row.emplace_back(i - 1, beside);
    if (i < n - 1) row.emplace_back(i + 1, beside);
    return row;
  });
}

/// Laplacian of a grid: five points, or the degrees of a graph on the diagonal.
petsc::Matrix grid(PetscInt nx, PetscInt ny, bool is_graph = false)  // NOLINT(readability-*)
{
  return matrix(nx * ny, 5, [=](PetscInt k) {
    const PetscInt i = k % nx, j = k / nx;
    Row row;
    if (i > 0) row.emplace_back(k - 1, -1.0);
    if (i < nx - 1) row.emplace_back(k + 1, -1.0);
    if (j > 0) row.emplace_back(k - nx, -1.0);
    if (j < ny - 1) row.emplace_back(k + nx, -1.0);
    row.emplace_back(k, is_graph ? double(row.size()) : 4.0);
    return row;
  });
}

petsc::Matrix cube(PetscInt n)
{
  return matrix(n * n * n, 7, [=](PetscInt k) {
    Row row{{k, 6.0}};
    PetscInt stride = 1;
    for (int axis = 0; axis < 3; ++axis, stride *= n) {
      const PetscInt i = k / stride % n;
      if (i > 0) row.emplace_back(k - stride, -1.0);
      if (i < n - 1) row.emplace_back(k + stride, -1.0);
    }
    return row;
  });
}

petsc::Matrix varied_mass(PetscInt n)
{
  return diagonal(n, [](PetscInt i) { return 2.0 + std::sin(double(i)); });
}

/// All eigenvalues, by LAPACK, ascending; without those at infinity.
std::vector<double> spectrum(Mat A, Mat B)
{
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
  petsc::check(EPSSetOperators(eps, A, B));
  petsc::check(EPSSetProblemType(eps, B ? EPS_GHEP : EPS_HEP));
  petsc::check(EPSSetType(eps, EPSLAPACK));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  petsc::check(EPSSolve(eps));
  PetscInt n = 0;
  petsc::check(EPSGetConverged(eps, &n));
  std::vector<double> values;
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar value = 0.0;
    petsc::check(EPSGetEigenvalue(eps, i, &value, nullptr));
    values.push_back(value);
  }
  std::ranges::sort(values);
  return values;
}

std::vector<double> nearest(std::vector<double> values, double target)
{
  std::ranges::sort(values, {}, [=](double x) { return std::abs(x - target); });
  return values;
}

std::vector<double> farthest(std::vector<double> values, double target)
{
  std::ranges::sort(values, std::greater<>(), [=](double x) { return std::abs(x - target); });
  return values;
}

std::vector<double> descending(std::vector<double> values)
{
  std::ranges::sort(values, std::greater<>());
  return values;
}

std::vector<double> between(const std::vector<double>& values, double low, double high)
{
  std::vector<double> some;
  std::ranges::copy_if(values, std::back_inserter(some),
                       [=](double x) { return x >= low - 1e-10 && x <= high + 1e-10; });
  return some;
}

petsc::EigenSolver program(Mat A, Mat B, PetscInt nev)
{
  petsc::check(CMSRegisterEPS());
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
  petsc::check(EPSSetOperators(eps, A, B));
  petsc::check(EPSSetProblemType(eps, B ? EPS_GHEP : EPS_HEP));
  petsc::check(EPSSetType(eps, "blocklanczos"));
  petsc::check(EPSSetDimensions(eps, nev, petsc::automatic, petsc::automatic));
  return eps;
}

PC preconditioner(EPS eps)
{
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STGetKSP(st, &ksp));
  petsc::check(KSPGetPC(ksp, &pc));
  return pc;
}

/// With a factor by MUMPS, which works on any number of ranks.
void use_factor(EPS eps)
{
  ST st = nullptr;
  KSP ksp = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STGetKSP(st, &ksp));
  petsc::check(KSPSetType(ksp, KSPPREONLY));
  petsc::check(PCSetType(preconditioner(eps), PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(preconditioner(eps), MATSOLVERMUMPS));
}

void invert_at(EPS eps, double target, STType type = STSINVERT)
{
  ST st = nullptr;
  petsc::check(EPSSetTarget(eps, target));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, type));
  use_factor(eps);
}

/// With a solver inside that iterates, to a tolerance of its own.
void invert_loosely_at(EPS eps, double target, double tolerance)
{
  ST st = nullptr;
  KSP ksp = nullptr;
  invert_at(eps, target);
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STGetKSP(st, &ksp));
  petsc::check(KSPSetType(ksp, KSPCG));
  petsc::check(KSPSetTolerances(ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 2000));
  petsc::check(PCSetType(preconditioner(eps), PCJACOBI));
}

std::vector<double> solved(EPS eps)
{
  petsc::check(EPSSolve(eps));
  PetscInt n = 0;
  petsc::check(EPSGetConverged(eps, &n));
  std::vector<double> values;
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar value = 0.0;
    petsc::check(EPSGetEigenvalue(eps, i, &value, nullptr));
    values.push_back(value);
  }
  return values;
}

double largest_error(EPS eps, PetscInt n)
{
  double largest = 0.0;
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal error = 0.0;
    petsc::check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
    largest = std::max(largest, double(error));
  }
  return largest;
}

/// Converged, to the first of the exact values, with printed errors below ten times the tolerance.
/// These are of a norm that the recurrence does not know.
void expect_the_first(EPS eps, const std::vector<double>& exact, double times_tolerance = 10.0)
{
  const std::vector<double> values = solved(eps);
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  PetscInt nev = 0;
  PetscReal tolerance = 0.0;
  petsc::check(EPSGetConvergedReason(eps, &reason));
  petsc::check(EPSGetDimensions(eps, &nev, nullptr, nullptr));
  petsc::check(EPSGetTolerances(eps, &tolerance, nullptr));
  EXPECT_GT(reason, 0);
  ASSERT_GE(std::ssize(values), nev);
  for (std::size_t i = 0; i < std::size_t(nev); ++i)
    EXPECT_NEAR(values[i], exact[i], 1e-7 * std::max(1.0, std::abs(exact[i]))) << i;
  EXPECT_LT(largest_error(eps, nev), times_tolerance * tolerance);
}

/// All values of an interval and no others, with vectors that are orthonormal in B.
void expect_all(EPS eps, const std::vector<double>& exact)
{
  const std::vector<double> values = solved(eps);
  ASSERT_EQ(values.size(), exact.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i], exact[i], 1e-9 * std::max(1.0, std::abs(exact[i]))) << i;
  BV V = nullptr;
  petsc::check(EPSGetBV(eps, &V));
  if (values.size() < 2) return;
  Mat products = nullptr;
  const auto n = static_cast<PetscInt>(values.size());
  petsc::check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, nullptr, &products));
  petsc::check(BVSetActiveColumns(V, 0, n));
  petsc::check(BVDot(V, V, products));
  petsc::check(MatShift(products, -1.0));
  PetscReal error = 0.0;
  petsc::check(MatNorm(products, NORM_FROBENIUS, &error));
  EXPECT_LT(error, 1e-7);
  petsc::check(MatDestroy(&products));
}

void seek_interval(EPS eps, double low, double high)
{
  ST st = nullptr;
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_ALL));
  petsc::check(EPSSetInterval(eps, low, high));
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSINVERT));
}

/// The message of a solve that is refused.
std::string refusal(EPS eps)
{
  static std::string text;
  text.clear();
  petsc::check(PetscPushErrorHandler(
      [](MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType type,
         const char* message, void*) -> PetscErrorCode {
        if (type == PETSC_ERROR_INITIAL && message) text += message;
        return code;
      },
      nullptr));
  const PetscErrorCode code = EPSSolve(eps);
  petsc::check(PetscPopErrorHandler());
  EXPECT_NE(code, 0);
  return text;
}

void expect_refusal(EPS eps, const std::string& what)
{
  const std::string text = refusal(eps);
  EXPECT_NE(text.find(what), std::string::npos) << "'" << text << "' does not say '" << what << "'";
}

/// A matrix that can do nothing but multiply.
petsc::Matrix shell_of(Mat A)
{
  petsc::Matrix shell;
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatCreateShell(PETSC_COMM_WORLD, n_local, n_local, n, n, A, shell.put()));
  const auto multiply = [](Mat S, Vec x, Vec y) -> PetscErrorCode {
    void* inside = nullptr;
    if (const PetscErrorCode code = MatShellGetContext(S, static_cast<void*>(&inside))) return code;
    return MatMult(static_cast<Mat>(inside), x, y);
  };
  petsc::check(MatShellSetOperation(
      shell, MATOP_MULT,
      reinterpret_cast<void (*)()>(static_cast<PetscErrorCode (*)(Mat, Vec, Vec)>(multiply))));
  return shell;
}

petsc::Vector filled(Mat A, const std::function<double(PetscInt)>& value)
{
  petsc::Vector v;
  PetscInt first = 0, last = 0;
  petsc::check(MatCreateVecs(A, v.put(), nullptr));
  petsc::check(VecGetOwnershipRange(v, &first, &last));
  for (PetscInt i = first; i < last; ++i) petsc::check(VecSetValue(v, i, value(i), INSERT_VALUES));
  petsc::check(VecAssemblyBegin(v));
  petsc::check(VecAssemblyEnd(v));
  return v;
}

void deflate(EPS eps, const std::vector<petsc::Vector>& space)
{
  std::vector<Vec> vectors(space.begin(), space.end());
  petsc::check(EPSSetDeflationSpace(eps, static_cast<PetscInt>(vectors.size()), vectors.data()));
}

/// The eigenvector k of a chain between fixed ends.
petsc::Vector chain_mode(Mat A, PetscInt k)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  return filled(A, [=](PetscInt i) {
    return std::sin(double(k + 1) * double(i + 1) * std::numbers::pi / double(n + 1));
  });
}

TEST(EpsPrograms, LargestOfAChain)
{
  const petsc::Matrix A = chain_of(130);
  expect_the_first(program(A, nullptr, 5), descending(spectrum(A, nullptr)));
}

TEST(EpsPrograms, LargestOfAGridAndSmallestOfACube)
{
  const petsc::Matrix A = grid(12, 13), C = cube(5);
  expect_the_first(program(A, nullptr, 6), descending(spectrum(A, nullptr)));
  const petsc::EigenSolver eps = program(C, nullptr, 8);
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  expect_the_first(eps, spectrum(C, nullptr));
}

TEST(EpsPrograms, MatrixThatOnlyMultiplies)
{
  const petsc::Matrix A = grid(10, 11);
  expect_the_first(program(shell_of(A), nullptr, 6), descending(spectrum(A, nullptr)));
}

TEST(EpsPrograms, DiagonalWithNegativeValues)
{
  const petsc::Matrix A = diagonal(90, [](PetscInt i) { return double(i) - 30.3; });
  const std::vector<double> all = spectrum(A, nullptr);
  for (const EPSWhich which :
       {EPS_SMALLEST_REAL, EPS_LARGEST_REAL, EPS_LARGEST_MAGNITUDE, EPS_SMALLEST_MAGNITUDE}) {
    const petsc::EigenSolver eps = program(A, nullptr, 4);
    petsc::check(EPSSetWhichEigenpairs(eps, which));
    expect_the_first(eps, which == EPS_SMALLEST_REAL        ? all
                          : which == EPS_SMALLEST_MAGNITUDE ? nearest(all, 0.0)
                          : which == EPS_LARGEST_REAL       ? descending(all)
                                                            : farthest(all, 0.0));
  }
}

TEST(EpsPrograms, FiedlerVectorByADeflationSpace)
{
  const petsc::Matrix A = grid(10, 11, true);
  std::vector<double> exact = spectrum(A, nullptr);
  exact.erase(exact.begin());  // the constant vector's
  std::vector<petsc::Vector> constant;
  constant.push_back(filled(A, [](PetscInt) { return 1.0; }));
  const petsc::EigenSolver outer = program(A, nullptr, 4);
  petsc::check(EPSSetWhichEigenpairs(outer, EPS_SMALLEST_REAL));
  deflate(outer, constant);
  expect_the_first(outer, exact);
  const petsc::EigenSolver inner = program(A, nullptr, 4);
  invert_at(inner, -0.1);
  deflate(inner, constant);
  expect_the_first(inner, exact);
}

/// A singular matrix whose null space is deflated, by a solver that iterates.
TEST(EpsPrograms, FiedlerVectorAtItsNullSpace)
{
  const petsc::Matrix A = grid(10, 11, true);
  std::vector<double> exact = spectrum(A, nullptr);
  exact.erase(exact.begin());
  std::vector<petsc::Vector> constant;
  constant.push_back(filled(A, [](PetscInt) { return 1.0; }));
  const petsc::EigenSolver eps = program(A, nullptr, 4);
  invert_loosely_at(eps, 0.0, 1e-11);
  deflate(eps, constant);
  expect_the_first(eps, exact, 1.0);
}

/// Of a generalised problem, vectors that are neither orthogonal nor of unit length.
TEST(EpsPrograms, DeflationInTheInnerProductOfB)
{
  const petsc::Matrix A = chain_of(120), B = varied_mass(120);
  const petsc::EigenSolver lowest = program(A, B, 3);
  invert_at(lowest, 0.0);
  petsc::check(EPSSolve(lowest));
  std::vector<petsc::Vector> space;
  for (PetscInt i = 0; i < 3; ++i) {
    space.push_back(filled(A, [](PetscInt) { return 0.0; }));
    petsc::check(EPSGetEigenvector(lowest, i, space.back(), nullptr));
    petsc::check(VecScale(space.back(), 3.0));
    if (i > 0) petsc::check(VecAXPY(space[std::size_t(i)], 0.5, space[std::size_t(i - 1)]));
  }
  std::vector<double> exact = spectrum(A, B);
  exact.erase(exact.begin(), exact.begin() + 3);
  const petsc::EigenSolver eps = program(A, B, 5);
  invert_at(eps, 0.0);
  deflate(eps, space);
  expect_the_first(eps, exact);
}

/// All that is left: the deflated vectors do not come back when nothing else is there.
TEST(EpsPrograms, DeflationOfAlmostEverything)
{
  const petsc::Matrix A = chain_of(12);
  std::vector<petsc::Vector> space;
  for (PetscInt k = 0; k < 8; ++k) space.push_back(chain_mode(A, k));
  const std::vector<double> all = spectrum(A, nullptr);
  const petsc::EigenSolver eps = program(A, nullptr, 10);
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  deflate(eps, space);
  const std::vector<double> values = solved(eps);
  ASSERT_EQ(values.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(values[i], all[8 + i], 1e-9);
}

TEST(EpsPrograms, GeneralisedAboutATarget)
{
  const petsc::Matrix A = grid(11, 12), B = varied_mass(132);
  const petsc::EigenSolver eps = program(A, B, 6);
  invert_at(eps, 1.3);
  expect_the_first(eps, nearest(spectrum(A, B), 1.3));
}

TEST(EpsPrograms, GeneralisedWithoutAShift)
{
  const petsc::Matrix A = chain_of(100), B = varied_mass(100);
  for (const EPSWhich which : {EPS_SMALLEST_REAL, EPS_LARGEST_REAL}) {
    const petsc::EigenSolver eps = program(A, B, 4);
    petsc::check(EPSSetWhichEigenpairs(eps, which));
    use_factor(eps);
    const std::vector<double> all = spectrum(A, B);
    expect_the_first(eps, which == EPS_SMALLEST_REAL ? all : descending(all));
  }
}

TEST(EpsPrograms, SingularB)
{
  const petsc::Matrix A = chain_of(80);
  const petsc::Matrix B = diagonal(80, [](PetscInt i) { return i % 4 == 0 ? 0.0 : 1.0; });
  const petsc::EigenSolver eps = program(A, B, 6);
  invert_at(eps, 0.0);
  // Condensed by hand: rows of zero mass follow statically. LAPACK takes no singular B.
  const petsc::EigenSolver other = program(A, B, 6);
  petsc::check(EPSSetType(other, EPSKRYLOVSCHUR));
  invert_at(other, 0.0);
  expect_the_first(eps, solved(other));
}

TEST(EpsPrograms, BlockFormatsAndShellB)
{
  const petsc::Matrix A = chain_of(96), B = varied_mass(96);
  petsc::Matrix A_blocks, B_blocks;
  petsc::check(MatConvert(A, MATSBAIJ, MAT_INITIAL_MATRIX, A_blocks.put()));
  petsc::check(MatConvert(B, MATSBAIJ, MAT_INITIAL_MATRIX, B_blocks.put()));
  const petsc::EigenSolver eps = program(A_blocks, B_blocks, 5);
  invert_at(eps, 0.0);
  expect_the_first(eps, spectrum(A, B));
}

/// (A - target)^2 by a shell matrix; the eigenvalues are those of the square.
TEST(EpsPrograms, SpectrumFolding)
{
  const petsc::Matrix A = chain_of(100, 2.0 - 1.1);
  petsc::Matrix square;
  petsc::check(MatMatMult(A, A, MAT_INITIAL_MATRIX, PETSC_DEFAULT, square.put()));
  petsc::check(MatSetOption(square, MAT_SYMMETRIC, PETSC_TRUE));
  const petsc::EigenSolver eps = program(shell_of(square), nullptr, 3);
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  petsc::check(EPSSetTolerances(eps, 1e-6, petsc::automatic));
  const std::vector<double> values = solved(eps);
  const std::vector<double> exact = spectrum(square, nullptr);
  ASSERT_GE(values.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(values[i], exact[i], 1e-8);
}

/// What a transformation of the user's own applies.
struct Transformation {
  KSP solver;
  Mat A;
  Vec work;
};

PetscErrorCode apply_inverse(ST st, Vec x, Vec y)
{
  void* context = nullptr;
  if (const PetscErrorCode code = STShellGetContext(st, static_cast<void*>(&context))) return code;
  return KSPSolve(static_cast<Transformation*>(context)->solver, x, y);
}

PetscErrorCode transform_back(ST, PetscInt n, PetscScalar* re, PetscScalar*)
{
  for (PetscInt i = 0; i < n; ++i) re[i] = 1.0 / re[i];
  return 0;
}

PetscErrorCode apply_square(ST st, Vec x, Vec y)
{
  void* context = nullptr;
  if (const PetscErrorCode code = STShellGetContext(st, static_cast<void*>(&context))) return code;
  const auto& fold = *static_cast<Transformation*>(context);
  petsc::check(MatMult(fold.A, x, fold.work));
  petsc::check(VecAXPY(fold.work, -1.1, x));
  petsc::check(MatMult(fold.A, fold.work, y));
  return VecAXPY(y, -1.1, fold.work);
}

TEST(EpsPrograms, TransformationOfOnesOwn)
{
  const petsc::Matrix A = grid(9, 10);
  petsc::LinearSolver solver;
  petsc::check(KSPCreate(PETSC_COMM_WORLD, solver.put()));
  petsc::check(KSPSetOperators(solver, A, A));
  petsc::check(KSPSetType(solver, KSPCG));
  petsc::check(KSPSetTolerances(solver, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  Transformation inverse{.solver = solver, .A = nullptr, .work = nullptr};
  const petsc::EigenSolver eps = program(A, nullptr, 5);
  ST st = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSHELL));
  petsc::check(STShellSetContext(st, &inverse));
  petsc::check(STShellSetApply(st, apply_inverse));
  petsc::check(STShellSetBackTransform(st, transform_back));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_MAGNITUDE));
  expect_the_first(eps, spectrum(A, nullptr), 1.0);
}

/// A mapping of two eigenvalues to one: SLEPc takes Rayleigh quotients.
TEST(EpsPrograms, TransformationWithoutAnInverse)
{
  const petsc::Matrix A = grid(9, 10);
  const petsc::Vector work = filled(A, [](PetscInt) { return 0.0; });
  Transformation fold{.solver = nullptr, .A = A, .work = work};
  const petsc::EigenSolver eps = program(A, nullptr, 4);
  ST st = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSHELL));
  petsc::check(STShellSetContext(st, &fold));
  petsc::check(STShellSetApply(st, apply_square));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  std::vector<double> found = solved(eps), exact = nearest(spectrum(A, nullptr), 1.1);
  ASSERT_EQ(found.size(), 4u);
  exact.resize(found.size());
  std::ranges::sort(found);
  std::ranges::sort(exact);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-7) << i;
}

TEST(EpsPrograms, Cayley)
{
  const petsc::Matrix A = chain_of(110), B = varied_mass(110);
  for (const bool is_generalised : {false, true}) {
    const petsc::EigenSolver eps = program(A, is_generalised ? Mat(B) : nullptr, 5);
    invert_at(eps, 0.7, STCAYLEY);
    expect_the_first(eps, nearest(spectrum(A, is_generalised ? Mat(B) : nullptr), 0.7), 100.0);
  }
}

/// Where A - sigma B takes the place of A for the time of the solve.
TEST(EpsPrograms, MatrixChangedInPlace)
{
  const petsc::Matrix B = varied_mass(110);
  const std::vector<double> exact = spectrum(chain_of(110), B);
  for (const bool is_interval : {false, true}) {
    const petsc::Matrix A = chain_of(110);
    const petsc::EigenSolver eps = program(A, B, 5);
    ST st = nullptr;
    invert_at(eps, 0.7);
    petsc::check(EPSGetST(eps, &st));
    petsc::check(STSetMatMode(st, ST_MATMODE_INPLACE));
    if (is_interval) {
      seek_interval(eps, 0.2, 0.9);
      expect_all(eps, between(exact, 0.2, 0.9));
    } else {
      expect_the_first(eps, nearest(exact, 0.7));
    }
  }
}

/// A solver inside that does not reach the tolerance of the pairs by one application.
TEST(EpsPrograms, LooseSolverInside)
{
  const petsc::Matrix A = grid(14, 15), B = varied_mass(210);
  const std::vector<double> exact = spectrum(A, B);
  for (const double tolerance : {1e-6, 1e-9}) {
    const petsc::EigenSolver eps = program(A, B, 4);
    invert_loosely_at(eps, 0.0, tolerance);
    petsc::check(EPSSetTolerances(eps, 1e-8, petsc::automatic));
    const std::vector<double> values = solved(eps);
    EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
    petsc::check(EPSGetConvergedReason(eps, &reason));
    const auto n = static_cast<PetscInt>(values.size());
    EXPECT_LE(largest_error(eps, std::min<PetscInt>(n, 4)), 1e-8);
    EXPECT_EQ(reason > 0, n >= 4);
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 4); ++i)
      EXPECT_NEAR(values[i], exact[i], 1e-8);
    if (tolerance < 1e-8) {
      EXPECT_GE(n, 4);
    }
  }
}

TEST(EpsPrograms, MatrixForThePreconditioner)
{
  const petsc::Matrix A = grid(12, 12), sparser = diagonal(144, [](PetscInt) { return 4.0; });
  const petsc::EigenSolver eps = program(A, nullptr, 4);
  invert_loosely_at(eps, 0.0, 1e-9);
  ST st = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetPreconditionerMat(st, sparser));
  expect_the_first(eps, spectrum(A, nullptr), 1.0);
}

TEST(EpsPrograms, TrueResiduals)
{
  const petsc::Matrix A = chain_of(400);
  for (const double heavy : {3.0, 1e4}) {  // the recurrence knows lengths in B alone
    const petsc::Matrix B = diagonal(400, [=](PetscInt i) { return i % 3 == 0 ? heavy : 1.0; });
    const std::vector<double> all = spectrum(A, B);
    for (const bool inverts : {true, false}) {
      const petsc::EigenSolver eps = program(A, B, 5);
      if (inverts)
        invert_at(eps, 1.3);
      else
        use_factor(eps);
      petsc::check(EPSSetTrueResidual(eps, PETSC_TRUE));
      petsc::check(EPSSetTolerances(eps, 1e-9, 100000));
      expect_the_first(eps, inverts ? nearest(all, 1.3) : descending(all), 1.0);
    }
  }
}

/// Where round-off does not let the errors become so small, the solve says so.
TEST(EpsPrograms, TrueResidualsThatCannotBe)
{
  const petsc::Matrix A = diagonal(200, [](PetscInt i) { return i < 100 ? 1.0 + i : 1e9 * i; });
  petsc::Matrix rotated;
  const petsc::Matrix R = matrix(200, 2, [](PetscInt i) {
    return Row{{i, 0.8}, {i < 100 ? i + 100 : i - 100, i < 100 ? 0.6 : -0.6}};
  });
  petsc::check(MatPtAP(A, R, MAT_INITIAL_MATRIX, PETSC_DEFAULT, rotated.put()));
  petsc::check(MatSetOption(rotated, MAT_SYMMETRIC, PETSC_TRUE));
  const petsc::EigenSolver eps = program(rotated, nullptr, 4);
  invert_at(eps, 0.0);
  petsc::check(EPSSetTrueResidual(eps, PETSC_TRUE));
  petsc::check(EPSSetTolerances(eps, 1e-13, petsc::automatic));
  const std::vector<double> values = solved(eps);
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  petsc::check(EPSGetConvergedReason(eps, &reason));
  EXPECT_LT(reason, 0);
  EXPECT_LT(values.size(), 4u);
  EXPECT_LE(largest_error(eps, static_cast<PetscInt>(values.size())), 1e-13);
}

TEST(EpsPrograms, BOrthonormalVectors)
{
  const petsc::Matrix A = grid(9, 9), B = varied_mass(81);
  const petsc::EigenSolver eps = program(A, B, 7);
  invert_at(eps, 0.0);
  expect_the_first(eps, spectrum(A, B));
  std::vector<petsc::Vector> x;
  const petsc::Vector Bx = filled(A, [](PetscInt) { return 0.0; });
  for (PetscInt i = 0; i < 7; ++i) {
    x.push_back(filled(A, [](PetscInt) { return 0.0; }));
    petsc::check(EPSGetEigenvector(eps, i, x.back(), nullptr));
    petsc::check(MatMult(B, x.back(), Bx));
    for (PetscInt j = 0; j <= i; ++j) {
      PetscScalar product = 0.0;
      petsc::check(VecDot(x[std::size_t(j)], Bx, &product));
      EXPECT_NEAR(product, i == j ? 1.0 : 0.0, 1e-11);
    }
  }
}

TEST(EpsPrograms, SeveralSolvesOfOneObject)
{
  const petsc::Matrix A = chain_of(100), other = chain_of(100, 3.0, -0.5), smaller = chain_of(60);
  const petsc::EigenSolver eps = program(A, nullptr, 4);
  const std::vector<double> all = spectrum(A, nullptr);
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_LARGEST_REAL));
  expect_the_first(eps, descending(all));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_SMALLEST_REAL));
  expect_the_first(eps, all);
  petsc::check(EPSSetOperators(eps, other, nullptr));
  expect_the_first(eps, spectrum(other, nullptr));
  petsc::check(EPSSetDimensions(eps, 7, 60, petsc::automatic));
  expect_the_first(eps, spectrum(other, nullptr));
  petsc::check(EPSSetOperators(eps, smaller, nullptr));
  expect_the_first(eps, spectrum(smaller, nullptr));
  invert_at(eps, 2.1);
  expect_the_first(eps, nearest(spectrum(smaller, nullptr), 2.1));
  seek_interval(eps, 0.5, 1.5);
  expect_all(eps, between(spectrum(smaller, nullptr), 0.5, 1.5));
  invert_at(eps, 2.1);
  petsc::check(EPSSetDimensions(eps, 5, petsc::automatic, petsc::automatic));
  expect_the_first(eps, nearest(spectrum(smaller, nullptr), 2.1));
}

TEST(EpsPrograms, ConvergenceTestOfOnesOwn)
{
  const petsc::Matrix A = chain_of(150);
  const petsc::EigenSolver eps = program(A, nullptr, 6);
  invert_at(eps, 0.0);
  static int calls;
  calls = 0;
  petsc::check(EPSSetConvergenceTestFunction(
      eps,
      [](EPS, PetscScalar value, PetscScalar, PetscReal residual, PetscReal* error,
         void*) -> PetscErrorCode {
        ++calls;
        *error = residual / std::abs(value) / 10.0;
        return 0;
      },
      nullptr, nullptr));
  expect_the_first(eps, spectrum(A, nullptr), 100.0);
  EXPECT_GT(calls, 0);
}

TEST(EpsPrograms, StoppingTestOfOnesOwn)
{
  const petsc::Matrix A = chain_of(150);
  const petsc::EigenSolver eps = program(A, nullptr, 20);
  invert_at(eps, 0.0);
  petsc::check(EPSSetStoppingTestFunction(
      eps,
      [](EPS, PetscInt, PetscInt, PetscInt n_converged, PetscInt, EPSConvergedReason* reason,
         void*) -> PetscErrorCode {
        if (n_converged >= 3) *reason = EPS_CONVERGED_USER;
        return 0;
      },
      nullptr, nullptr));
  const std::vector<double> values = solved(eps), exact = spectrum(A, nullptr);
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  petsc::check(EPSGetConvergedReason(eps, &reason));
  EXPECT_EQ(reason, EPS_CONVERGED_USER);
  ASSERT_GE(values.size(), 3u);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], exact[i], 1e-9);
}

TEST(EpsPrograms, Monitors)
{
  const petsc::Matrix A = chain_of(150);
  static PetscInt calls, last;
  calls = last = 0;
  const auto count = [](EPS, PetscInt its, PetscInt n_converged, PetscScalar*, PetscScalar*,
                        PetscReal*, PetscInt, void*) -> PetscErrorCode {
    EXPECT_EQ(its, ++calls);
    last = n_converged;
    return 0;
  };
  const petsc::EigenSolver eps = program(A, nullptr, 5);
  petsc::check(EPSMonitorSet(eps, count, nullptr, nullptr));
  invert_at(eps, 0.0);
  expect_the_first(eps, spectrum(A, nullptr));
  EXPECT_GE(last, 5);
  calls = 0;
  seek_interval(eps, 0.1, 0.9);
  petsc::check(EPSSolve(eps));
}

TEST(EpsPrograms, InitialSpaceOfExactVectors)
{
  const petsc::Matrix A = chain_of(140);
  std::vector<petsc::Vector> guesses;
  for (PetscInt k = 0; k < 5; ++k) guesses.push_back(chain_mode(A, k));
  std::vector<Vec> vectors(guesses.begin(), guesses.end());
  const petsc::EigenSolver eps = program(A, nullptr, 5);
  invert_at(eps, 0.0);
  petsc::check(EPSSetInitialSpace(eps, 5, vectors.data()));
  expect_the_first(eps, spectrum(A, nullptr));
}

TEST(EpsPrograms, OrderOfOnesOwn)
{
  const petsc::Matrix A = diagonal(120, [](PetscInt i) { return double(i) - 40.3; });
  std::vector<double> exact = descending(between(spectrum(A, nullptr), -100.0, 0.0));
  const petsc::EigenSolver eps = program(A, nullptr, 4);
  invert_at(eps, -0.1);
  petsc::check(EPSSetEigenvalueComparison(
      eps,
      [](PetscScalar a, PetscScalar, PetscScalar b, PetscScalar, PetscInt* order,
         void*) -> PetscErrorCode {  // negative ones first, the nearest to zero
        const bool a_first = (a < 0.0) != (b < 0.0) ? a < 0.0 : std::abs(a) < std::abs(b);
        *order = a == b ? 0 : a_first ? -1 : 1;
        return 0;
      },
      nullptr));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_WHICH_USER));
  expect_the_first(eps, exact);
}

TEST(EpsPrograms, ConvergenceTestsOfSlepc)
{
  const petsc::Matrix A = chain_of(150), B = varied_mass(150);
  for (const EPSConv test : {EPS_CONV_ABS, EPS_CONV_REL, EPS_CONV_NORM}) {
    const petsc::EigenSolver eps = program(A, B, 5);
    invert_at(eps, 0.05);
    petsc::check(EPSSetConvergenceTest(eps, test));
    const std::vector<double> values = solved(eps), exact = nearest(spectrum(A, B), 0.05);
    ASSERT_GE(values.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(values[i], exact[i], 1e-6);
  }
}

TEST(EpsPrograms, OptionsWithAPrefix)
{
  const petsc::Matrix A = chain_of(100);
  petsc::check(CMSRegisterEPS());
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
  petsc::check(EPSSetOptionsPrefix(eps, "programs_"));
  petsc::check(PetscOptionsInsertString(
      nullptr,
      "-programs_eps_type blocklanczos -programs_eps_nev 3 -programs_eps_hermitian "
      "-programs_st_type sinvert -programs_eps_target 0.2 -programs_st_pc_type cholesky "
      "-programs_st_pc_factor_mat_solver_type mumps -programs_eps_blocklanczos_blocksize 3"));
  petsc::check(EPSSetOperators(eps, A, nullptr));
  petsc::check(EPSSetFromOptions(eps));
  expect_the_first(eps, nearest(spectrum(A, nullptr), 0.2));
}

/// A test of convergence sees eigenvalues with their sign, also those of an interval.
TEST(EpsPrograms, ConvergenceTestOfAnIntervalSeesItsEigenvalues)
{
  const petsc::Matrix A = diagonal(150, [](PetscInt i) { return 0.1 * double(i) - 10.05; });
  static double lowest, highest;
  lowest = 1e9;
  highest = -1e9;
  const petsc::EigenSolver eps = program(A, nullptr, 1);
  petsc::check(EPSSetConvergenceTestFunction(
      eps,
      [](EPS, PetscScalar value, PetscScalar, PetscReal residual, PetscReal* error,
         void*) -> PetscErrorCode {
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
        *error = residual;
        return 0;
      },
      nullptr, nullptr));
  seek_interval(eps, -6.0, -2.0);
  expect_all(eps, between(spectrum(A, nullptr), -6.0, -2.0));
  EXPECT_GT(lowest, -6.2);
  EXPECT_LT(highest, -1.8);
}

/// Error estimates of an interval are relative to its eigenvalues: the same in units 2^20 times
/// smaller, but for the round-off of numbers relative to these.
TEST(EpsPrograms, ErrorsOfAnIntervalHaveTheUnitOfItsEigenvalues)
{
  constexpr double unit = 1 << 20;
  std::vector<double> errors[2];
  for (const int k : {0, 1}) {
    const double u = k == 0 ? 1.0 : unit;
    const petsc::Matrix A = chain_of(150, 2.0 * u, -u);
    const petsc::EigenSolver eps = program(A, nullptr, 1);
    seek_interval(eps, 0.3 * u, 0.9 * u);
    const std::size_t n = solved(eps).size();
    ASSERT_GT(n, 10u);
    for (std::size_t i = 0; i < n; ++i) {
      PetscReal error = 0.0;
      petsc::check(EPSGetErrorEstimate(eps, static_cast<PetscInt>(i), &error));
      errors[k].push_back(error);
    }
  }
  ASSERT_EQ(errors[0].size(), errors[1].size());
  for (std::size_t i = 0; i < errors[0].size(); ++i)
    EXPECT_NEAR(errors[1][i], errors[0][i], std::numeric_limits<double>::epsilon()) << i;
}

/// Lengths of vectors that are orthonormal in a light B are far from one. (In a heavy one the
/// round-off of A x is more than the tolerance of lambda B x.)
TEST(EpsPrograms, TrueResidualsInAnyUnitOfMass)
{
  const petsc::Matrix A = chain_of(200);
  for (const double mass : {1e-12, 1e-6}) {
    const petsc::Matrix B =
        diagonal(200, [=](PetscInt i) { return i % 3 == 0 ? 2.0 * mass : mass; });
    std::vector<double> exact =
        spectrum(A, diagonal(200, [](PetscInt i) { return i % 3 == 0 ? 2.0 : 1.0; }));
    for (double& value : exact) value /= mass;
    const petsc::EigenSolver eps = program(A, B, 5);
    invert_at(eps, 0.0);
    petsc::check(EPSSetTrueResidual(eps, PETSC_TRUE));
    petsc::check(EPSSetTolerances(eps, 1e-9, petsc::automatic));
    const std::vector<double> values = solved(eps);
    EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
    petsc::check(EPSGetConvergedReason(eps, &reason));
    EXPECT_GT(reason, 0);
    ASSERT_GE(values.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      PetscReal printed = 0.0, estimate = 0.0;
      EXPECT_NEAR(values[i] / exact[i], 1.0, 1e-9) << i;
      petsc::check(EPSComputeError(eps, static_cast<PetscInt>(i), EPS_ERROR_RELATIVE, &printed));
      petsc::check(EPSGetErrorEstimate(eps, static_cast<PetscInt>(i), &estimate));
      EXPECT_LE(printed, 1e-9);
      EXPECT_NEAR(estimate, printed, 0.01 * printed) << i;
    }
  }
}

TEST(EpsPrograms, TwoIntervalsOfAGeneralisedProblem)
{
  const petsc::Matrix A = grid(12, 11), B = varied_mass(132);
  const std::vector<double> all = spectrum(A, B);
  const petsc::EigenSolver eps = program(A, B, 1);
  for (const auto& [low, high] : {std::pair{1.1, 1.3}, std::pair{1.499, 1.9}}) {
    seek_interval(eps, low, high);
    expect_all(eps, between(all, low, high));
  }
}

TEST(EpsPrograms, IntervalsThatHoldNothingOneOrAll)
{
  const petsc::Matrix A = chain_of(150);
  const std::vector<double> all = spectrum(A, nullptr);
  const double gap = 0.5 * (all[20] + all[21]), half = 0.5 * (all[21] - all[20]);
  for (const auto& [low, high] :
       {std::pair{-3.0, -1.0}, std::pair{gap - 0.4 * half, gap + 0.4 * half}, std::pair{5.0, 9.0},
        std::pair{gap, gap + 1.5 * half}, std::pair{-1.0, 1e6}, std::pair{-1e9, 0.2},
        std::pair{-2.0, 4.5}}) {
    SCOPED_TRACE(testing::Message() << low << " .. " << high);
    const petsc::EigenSolver eps = program(A, nullptr, 1);
    seek_interval(eps, low, high);
    expect_all(eps, between(all, low, high));
  }
}

/// Ends on eigenvalues, single and of many copies: they belong to the interval.
TEST(EpsPrograms, IntervalsThatEndOnEigenvalues)
{
  const petsc::Matrix A = diagonal(160, [](PetscInt i) { return double(1 + i % 20); });
  const std::vector<double> all = spectrum(A, nullptr);
  for (const auto& [low, high] : {std::pair{3.0, 6.0}, std::pair{3.0, 5.5}, std::pair{0.0, 1.0},
                                  std::pair{20.0, 21.0}, std::pair{4.5, 9.0}}) {
    SCOPED_TRACE(testing::Message() << low << " .. " << high);
    const petsc::EigenSolver eps = program(A, nullptr, 1);
    seek_interval(eps, low, high);
    expect_all(eps, between(all, low, high));
  }
}

/// More copies than a block has vectors, and a shift in the middle of the interval on them, but for
/// so little that a factor exists, which has digits of nothing else.
TEST(EpsPrograms, IntervalsWithManyCopiesInTheMiddle)
{
  for (const double beside : {0.0, 1e-13, 1e-9}) {
    const petsc::Matrix A =
        diagonal(1500, [=](PetscInt i) { return i < 60 ? 2.0 + beside : 0.05 * double(i); });
    const petsc::EigenSolver eps = program(A, nullptr, 1);
    seek_interval(eps, 1.0, 3.0);
    std::vector<double> exact(61, 2.0 + beside);
    exact.back() = 3.0;
    expect_all(eps, exact);
  }
}

/// A cluster on both sides of an end, at distances of round-off and more.
TEST(EpsPrograms, IntervalsWithAClusterAtTheirEnd)
{
  const petsc::Matrix A = diagonal(
      120, [](PetscInt i) { return i < 12 ? 2.0 + 1e-5 * double(i - 6) : 3.0 + 0.1 * double(i); });
  const petsc::EigenSolver eps = program(A, nullptr, 1);
  seek_interval(eps, 2.0, 6.02);
  const std::vector<double> all = spectrum(A, nullptr);
  expect_all(eps, between(all, 2.0, 6.02));
  seek_interval(eps, 0.0, 2.0);
  expect_all(eps, between(all, 0.0, 2.0));
}

/// Many slices, of a body that can move freely and has massless rows.
TEST(EpsPrograms, IntervalOfManySlices)
{
  const petsc::Matrix A = grid(30, 31, true);
  const petsc::Matrix B = diagonal(930, [](PetscInt i) { return i % 5 == 3 ? 0.0 : 1.0; });
  const petsc::EigenSolver eps = program(A, B, 1);
  seek_interval(eps, -0.01, 3.0);
  const std::vector<double> values = solved(eps);
  EXPECT_GT(values.size(), 240u);
  ASSERT_FALSE(values.empty());
  EXPECT_NEAR(values[0], 0.0, 1e-9);
  EXPECT_LT(largest_error(eps, 1), 1e10);  // relative to zero
  for (PetscInt i = 1; i < std::ssize(values); ++i) {
    PetscReal error = 1.0;
    petsc::check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
    EXPECT_LT(error, 1e-6) << i << ": " << values[std::size_t(i)];
  }
  constexpr PetscInt n_lowest = 60;
  const petsc::EigenSolver other = program(A, B, n_lowest);  // from one end, by counting copies
  invert_at(other, -0.01);
  const std::vector<double> lowest = solved(other);
  ASSERT_GE(lowest.size(), std::size_t(n_lowest));
  for (std::size_t i = 0; i < n_lowest; ++i) EXPECT_NEAR(values[i], lowest[i], 1e-8);
}

/// By the factor of the plugin, in SLEPc's own spectrum slicing and in ours.
TEST(EpsPrograms, IntervalsByTheFactorOfThePlugin)
{
  const petsc::Matrix A = grid(12, 11), B = varied_mass(132);
  const std::vector<double> exact = between(spectrum(A, B), 0.4, 1.7);
  petsc::check(CMSInitializePackage());
  for (const char* package : {"supernodal", "mumps-metis"}) {
    SCOPED_TRACE(package);
    const petsc::EigenSolver ours = program(A, B, 1);
    seek_interval(ours, 0.4, 1.7);
    petsc::check(PCSetType(preconditioner(ours), PCCHOLESKY));
    petsc::check(PCFactorSetMatSolverType(preconditioner(ours), package));
    expect_all(ours, exact);
    const petsc::EigenSolver theirs = program(A, B, 1);
    petsc::check(EPSSetType(theirs, EPSKRYLOVSCHUR));
    petsc::check(EPSSetOptionsPrefix(theirs, "theirs_"));
    petsc::check(PetscOptionsInsertString(
        nullptr,
        ("-theirs_eps_interval 0.4,1.7 -theirs_st_type sinvert -theirs_st_pc_type cholesky "
         "-theirs_st_pc_factor_mat_solver_type " +
         std::string(package))
            .c_str()));
    petsc::check(EPSSetFromOptions(theirs));
    const std::vector<double> found = solved(theirs);
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-8);
  }
}

/// Beside zero an eigenvalue of twelve digits less than the others.
TEST(EpsPrograms, NearlySingularAtTheTarget)
{
  const petsc::Matrix A = diagonal(100, [](PetscInt i) { return i == 41 ? 1e-12 : 1.0 + i; });
  const petsc::EigenSolver eps = program(A, nullptr, 3);
  invert_at(eps, 0.0);
  const std::vector<double> values = solved(eps);
  ASSERT_GE(values.size(), 3u);
  EXPECT_NEAR(values[0], 1e-12, 1e-20);
  EXPECT_NEAR(values[1], 1.0, 1e-9);
  EXPECT_NEAR(values[2], 2.0, 1e-9);
}

/// The same of a full matrix, in which the small eigenvalue has four digits.
TEST(EpsPrograms, NearlySingularAndFull)
{
  constexpr PetscInt n = 60;
  const double h = std::sqrt(2.0 / (n + 1));
  const auto entry = [=](PetscInt i, PetscInt j) {
    double sum = 0.0;
    for (PetscInt k = 0; k < n; ++k) {
      sum += (k == 0 ? 1e-12 : double(k)) * h * h *
             std::sin(double(k + 1) * double(i + 1) * std::numbers::pi / (n + 1)) *
             std::sin(double(k + 1) * double(j + 1) * std::numbers::pi / (n + 1));
    }
    return sum;
  };
  const petsc::Matrix A = matrix(n, n, [&](PetscInt i) {
    Row row;
    for (PetscInt j = 0; j < n; ++j) row.emplace_back(j, i < j ? entry(i, j) : entry(j, i));
    return row;
  });
  const petsc::EigenSolver eps = program(A, nullptr, 3);
  invert_at(eps, 0.0);
  const std::vector<double> values = solved(eps);
  ASSERT_GE(values.size(), 3u);
  EXPECT_NEAR(values[0], 0.0, 1e-12);
  EXPECT_NEAR(values[1], 1.0, 1e-8);
  EXPECT_NEAR(values[2], 2.0, 1e-8);
}

TEST(EpsPrograms, IndefiniteBIsRefused)
{
  const petsc::Matrix A = chain_of(80);
  const petsc::Matrix by_diagonal = diagonal(80, [](PetscInt i) { return i == 50 ? -1.0 : 1.0; });
  const petsc::Matrix hidden = matrix(80, 2, [](PetscInt i) {  // pairs of 1 +- 2
    return Row{{i, 1.0}, {i ^ 1, i / 2 == 7 ? 2.0 : 0.0}};
  });
  for (const bool inverts : {true, false}) {
    for (const auto& [B, what] : {std::pair{Mat(by_diagonal), "-1 on its diagonal in row 50"},
                                  std::pair{Mat(hidden), "indefinite"}}) {
      const petsc::EigenSolver eps = program(A, B, 70);
      if (inverts)
        invert_at(eps, 0.0);
      else
        use_factor(eps);
      expect_refusal(eps, what);
    }
  }
}

/// Each row of what is refused, as a program asks for it.
TEST(EpsPrograms, WhatIsRefusedSaysWhy)
{
  const petsc::Matrix A = chain_of(60), B = varied_mass(60);
  const auto expect = [&](const std::string& what, Mat second,
                          const std::function<void(EPS)>& ask) {
    const petsc::EigenSolver eps = program(A, second, 3);
    ask(eps);
    expect_refusal(eps, "blocklanczos refuses " + what);
  };
  expect("problems that are not symmetric", nullptr,
         [](EPS eps) { petsc::check(EPSSetProblemType(eps, EPS_NHEP)); });
  expect("an indefinite B", B, [](EPS eps) { petsc::check(EPSSetProblemType(eps, EPS_GHIEP)); });
  expect("balancing", nullptr,
         [](EPS eps) { petsc::check(EPSSetBalance(eps, EPS_BALANCE_TWOSIDE, 5, 1e-8)); });
  expect("harmonic", nullptr, [](EPS eps) { petsc::check(EPSSetExtraction(eps, EPS_HARMONIC)); });
  expect("regions", nullptr, [](EPS eps) {
    RG region = nullptr;
    petsc::check(EPSGetRG(eps, &region));
    petsc::check(RGSetType(region, RGELLIPSE));
    petsc::check(RGEllipseSetParameters(region, 1.0, 0.2, 1.0));
  });
  expect("arbitrary selection", nullptr, [](EPS eps) {
    petsc::check(EPSSetArbitrarySelection(
        eps,
        [](PetscScalar, PetscScalar, Vec, Vec, PetscScalar*, PetscScalar*,
           void*) -> PetscErrorCode { return 0; },
        nullptr));
  });
  expect("transformations other than", nullptr, [](EPS eps) {
    ST st = nullptr;
    petsc::check(EPSGetST(eps, &st));
    petsc::check(STSetType(st, STFILTER));
  });
  expect("all eigenvalues without an interval", nullptr,
         [](EPS eps) { petsc::check(EPSSetWhichEigenpairs(eps, EPS_ALL)); });
  expect("an interval with an end at infinity", nullptr,
         [](EPS eps) { seek_interval(eps, 0.1, PETSC_MAX_REAL); });
  expect("an interval without -st_type sinvert", nullptr, [](EPS eps) {
    petsc::check(EPSSetWhichEigenpairs(eps, EPS_ALL));
    petsc::check(EPSSetInterval(eps, 0.1, 0.2));
  });
  expect("an interval with an iterative solver", nullptr, [](EPS eps) {
    invert_loosely_at(eps, 0.0, 1e-8);
    seek_interval(eps, 0.1, 0.2);
  });
  expect("an interval with a deflation space", nullptr, [&](EPS eps) {
    std::vector<petsc::Vector> space;
    space.push_back(chain_mode(A, 0));
    deflate(eps, space);
    seek_interval(eps, 0.1, 0.2);
  });
  expect("an interval with a stopping test", nullptr, [](EPS eps) {
    seek_interval(eps, 0.1, 0.2);
    petsc::check(EPSSetStoppingTestFunction(
        eps,
        [](EPS, PetscInt, PetscInt, PetscInt, PetscInt, EPSConvergedReason*,
           void*) -> PetscErrorCode { return 0; },
        nullptr, nullptr));
  });
  const petsc::EigenSolver of_shell = program(shell_of(A), nullptr, 3);
  seek_interval(of_shell, 0.1, 0.2);
  expect_refusal(of_shell, "blocklanczos refuses an interval of matrices that only multiply");
  const petsc::EigenSolver narrow = program(A, nullptr, 3);
  seek_interval(narrow, 1.0, 1.0 + 1e-12);
  expect_refusal(narrow, "as narrow as the round-off of its ends");
}

}  // namespace
}  // namespace chladni::plugin
