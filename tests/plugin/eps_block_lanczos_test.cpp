// The solver type "blocklanczos" beside spectra that are known, through SLEPc's interface alone.
#include <chladni_cms.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::diagonal, linear::testing::matrix, linear::testing::Row;

/// The Laplacian of the hypercube with d dimensions: eigenvalues 2 k with multiplicity binom(d, k).
petsc::Matrix hypercube(int d)
{
  return matrix(PetscInt(1) << d, d + 1, [=](PetscInt i) {
    Row row{{i, d}};
    for (int bit = 0; bit < d; ++bit) row.emplace_back(i ^ (PetscInt(1) << bit), -1.0);
    return row;
  });
}

struct Search {
  PetscInt nev = 6;
  bool inverts = true;
  double target = 0.0;
  PetscInt ncv = petsc::automatic;
};

/// An EPS with the solver type, shift and invert with MUMPS.
petsc::EigenSolver solver(Mat A, Mat B, const Search& search)
{
  petsc::check(CMSRegisterEPS());
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(PETSC_COMM_WORLD, eps.put()));
  petsc::check(EPSSetOperators(eps, A, B));
  petsc::check(EPSSetProblemType(eps, B != nullptr ? EPS_GHEP : EPS_HEP));
  petsc::check(EPSSetType(eps, "blocklanczos"));
  petsc::check(EPSSetDimensions(eps, search.nev, search.ncv, petsc::automatic));
  petsc::check(EPSSetTarget(eps, search.target));
  if (!search.inverts) return eps;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSINVERT));
  petsc::check(STGetKSP(st, &ksp));
  petsc::check(KSPSetType(ksp, KSPPREONLY));
  petsc::check(KSPGetPC(ksp, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  petsc::check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  return eps;
}

/// The eigenvalues that it says have converged; each with a small residual ||A x - lambda B x||.
std::vector<double> converged(EPS eps)
{
  PetscInt n = 0;
  petsc::check(EPSGetConverged(eps, &n));
  std::vector<double> lambda;
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar value = 0.0;
    PetscReal error = 0.0;
    petsc::check(EPSGetEigenpair(eps, i, &value, nullptr, nullptr, nullptr));
    petsc::check(EPSComputeError(eps, i, EPS_ERROR_ABSOLUTE, &error));
    EXPECT_LT(error, 1e-5) << "pair " << i << ", eigenvalue " << value;
    lambda.push_back(value);
  }
  return lambda;
}

/// The first nev of the exact eigenvalues, which come in the wanted order.
void expect_first(EPS eps, const std::vector<double>& exact)
{
  petsc::check(EPSSolve(eps));
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  petsc::check(EPSGetConvergedReason(eps, &reason));
  EXPECT_GT(reason, 0);
  PetscInt nev = 0;
  petsc::check(EPSGetDimensions(eps, &nev, nullptr, nullptr));
  const std::vector<double> lambda = converged(eps);
  ASSERT_GE(std::ssize(lambda), nev);
  for (std::size_t i = 0; i < lambda.size(); ++i) EXPECT_NEAR(lambda[i], exact[i], 1e-9) << i;
}

std::vector<double> hypercube_spectrum(int d)
{
  std::vector<double> lambda;
  for (unsigned i = 0; i < 1u << d; ++i) lambda.push_back(2.0 * std::popcount(i));
  std::ranges::sort(lambda);
  return lambda;
}

TEST(EpsBlockLanczos, FindsAllCopiesOfTheIdentity)
{
  const petsc::Matrix I = diagonal(300, [](PetscInt) { return 1.0; });
  for (const bool inverts : {false, true}) {
    for (const PetscInt nev : {20, 300}) {
      expect_first(solver(I, nullptr, {.nev = nev, .inverts = inverts}),
                   std::vector<double>(300, 1.0));
    }
  }
}

TEST(EpsBlockLanczos, FindsAllCopiesOfTheZeroMatrix)
{
  const petsc::Matrix zero = diagonal(100, [](PetscInt) { return 0.0; });
  const std::vector<double> exact(100, 0.0);
  expect_first(solver(zero, nullptr, {.nev = 12, .inverts = false}), exact);
  expect_first(solver(zero, nullptr, {.nev = 12, .target = -1.0}), exact);
}

TEST(EpsBlockLanczos, FindsTheBinomialMultiplicitiesOfAHypercube)
{
  const petsc::Matrix A = hypercube(9);
  std::vector<double> exact = hypercube_spectrum(9);
  expect_first(solver(A, nullptr, {.nev = 40, .target = -0.5}), exact);
  std::ranges::reverse(exact);
  expect_first(solver(A, nullptr, {.nev = 40, .inverts = false}), exact);
}

TEST(EpsBlockLanczos, FindsFiftyCopiesAndMore)
{
  const petsc::Matrix A = diagonal(1000, [](PetscInt i) { return 1.0 + i % 20; });
  std::vector<double> exact;
  for (PetscInt i = 0; i < 1000; ++i) exact.push_back(1.0 + i / 50);
  expect_first(solver(A, nullptr, {.nev = 120}), exact);
}

TEST(EpsBlockLanczos, IsRightWithTheTargetOnAnEigenvalue)
{
  constexpr PetscInt n = 300;
  const linear::testing::Chain chain = linear::testing::free_chain(n);  // the graph of a path
  petsc::check(MatSetOption(chain.K, MAT_SYMMETRIC, PETSC_TRUE));
  std::vector<double> exact;
  for (PetscInt k = 0; k < n; ++k)
    exact.push_back(4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / n), 2));
  expect_first(solver(chain.K, nullptr, {.nev = 12}), exact);
  expect_first(solver(chain.K, chain.M, {.nev = 12}), exact);
}

TEST(EpsBlockLanczos, NeverSaysConvergedOfWhatIsNot)
{
  // On and beside an eigenvalue of multiplicity 9: a factor without digits. Fewer may converge.
  const petsc::Matrix A = hypercube(9);
  for (const double target : {2.0, 2.0 + 1e-13, 2.0 + 1e-7}) {
    const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 20, .target = target});
    petsc::check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
    const PetscErrorCode code = EPSSolve(eps);
    petsc::check(PetscPopErrorHandler());
    if (code != 0) continue;
    EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
    petsc::check(EPSGetConvergedReason(eps, &reason));
    const std::vector<double> lambda = converged(eps);
    EXPECT_EQ(reason > 0, lambda.size() >= 20);
    for (const double value : lambda)
      EXPECT_NEAR(value, 2.0 * std::round(0.5 * value), 1e-5) << "target " << target;
  }
}

/// A chain on which pairs of DOFs share a mass: B has the rank n / 2, by round-off only.
struct ChainWithSharedMasses {
  static constexpr PetscInt n = 200;
  petsc::Matrix A = matrix(n, 3, [](PetscInt i) {
    Row row{{i, 2.0}};
    if (i > 0) row.emplace_back(i - 1, -1.0);
    if (i < n - 1) row.emplace_back(i + 1, -1.0);
    return row;
  });
  petsc::Matrix B = matrix(n, 2, [](PetscInt i) {
    const double c = std::cos(0.3), s = std::sin(0.3);
    return Row{{i, i % 2 == 0 ? c * c : s * s}, {i ^ 1, c * s}};
  });
};

TEST(EpsBlockLanczos, HasTrueResidualsWhereASingularBEnds)
{
  const ChainWithSharedMasses chain;
  const petsc::EigenSolver eps = solver(chain.A, chain.B, {.nev = chain.n, .ncv = chain.n});
  petsc::check(EPSSolve(eps));
  EXPECT_EQ(converged(eps).size(), chain.n / 2u);
  EPSConvergedReason reason = EPS_CONVERGED_ITERATING;
  petsc::check(EPSGetConvergedReason(eps, &reason));
  EXPECT_EQ(reason, EPS_DIVERGED_BREAKDOWN);  // B has no more
}

TEST(EpsBlockLanczos, FindsEveryShareOfTheRankOfASingularB)
{
  const ChainWithSharedMasses chain;
  const petsc::EigenSolver whole = solver(chain.A, chain.B, {.nev = chain.n, .ncv = chain.n});
  petsc::check(EPSSolve(whole));
  const std::vector<double> all = converged(whole);
  for (const PetscInt nev : {25, 50, 75, 99, 100})
    expect_first(solver(chain.A, chain.B, {.nev = nev}), all);
}

TEST(EpsBlockLanczos, KeepsWithinTheSmallestBasis)
{
  const petsc::Matrix A = hypercube(8);
  const std::vector<double> exact = hypercube_spectrum(8);
  for (const char* keep : {"0", "0.5", "0.7", "0.9"}) {
    petsc::check(PetscOptionsSetValue(nullptr, "-small_eps_blocklanczos_restart", keep));
    for (const PetscInt ncv : {22, 24, 30}) {
      const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 6, .target = -0.5, .ncv = ncv});
      petsc::check(EPSSetOptionsPrefix(eps, "small_"));
      petsc::check(EPSSetFromOptions(eps));
      expect_first(eps, exact);
    }
  }
  petsc::check(PetscOptionsClearValue(nullptr, "-small_eps_blocklanczos_restart"));
}

petsc::Matrix laplacian(PetscInt n)
{
  return matrix(n, 3, [n](PetscInt i) {
    Row row{{i, 2.0}};
    if (i > 0) row.emplace_back(i - 1, -1.0);
    if (i < n - 1) row.emplace_back(i + 1, -1.0);
    return row;
  });
}

std::vector<double> laplacian_spectrum(PetscInt n)
{
  std::vector<double> lambda;
  for (PetscInt k = 1; k <= n; ++k)
    lambda.push_back(4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / (n + 1)), 2));
  return lambda;
}

TEST(EpsBlockLanczos, TakesFewerStepsWhereARestartKeepsMore)
{
  const petsc::Matrix A = laplacian(400);
  PetscInt steps[2];
  for (const int k : {0, 1}) {
    petsc::check(PetscOptionsSetValue(nullptr, "-kept_eps_blocklanczos_restart", k ? "0.6" : "0"));
    const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 4, .inverts = false, .ncv = 40});
    petsc::check(EPSSetOptionsPrefix(eps, "kept_"));
    petsc::check(EPSSetFromOptions(eps));
    petsc::check(EPSSetTolerances(eps, 1e-6, 10000));
    petsc::check(EPSSolve(eps));
    petsc::check(EPSGetIterationNumber(eps, &steps[k]));
    EXPECT_GE(converged(eps).size(), 4u);
  }
  EXPECT_LT(steps[1], 0.8 * steps[0]);
  petsc::check(PetscOptionsClearValue(nullptr, "-kept_eps_blocklanczos_restart"));
}

/// Of a grid of 72 x 72, the four largest: with blocks of 8, a basis of 20 restarted for ever.
TEST(EpsBlockLanczos, DoesNotStarveInASubspaceForOneVectorAtATime)
{
  constexpr PetscInt side = 72;
  const petsc::Matrix A = matrix(side * side, 5, [](PetscInt i) {
    Row row{{i, 4.0}};
    if (i % side > 0) row.emplace_back(i - 1, -1.0);
    if (i % side < side - 1) row.emplace_back(i + 1, -1.0);
    if (i >= side) row.emplace_back(i - side, -1.0);
    if (i < side * (side - 1)) row.emplace_back(i + side, -1.0);
    return row;
  });
  std::vector<double> exact;
  for (const double x : laplacian_spectrum(side))
    for (const double y : laplacian_spectrum(side)) exact.push_back(x + y);
  std::ranges::sort(exact, std::greater<>());
  const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 4, .inverts = false, .ncv = 20});
  expect_first(eps, exact);
}

TEST(EpsBlockLanczos, HasErrorsBelowItsToleranceWhenItInverts)
{
  const petsc::Matrix A = laplacian(1000);
  for (const double tolerance : {1e-6, 1e-8}) {
    const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 6});
    petsc::check(EPSSetTolerances(eps, tolerance, petsc::automatic));
    expect_first(eps, laplacian_spectrum(1000));
    for (PetscInt i = 0; i < 6; ++i) {
      PetscReal error = 1.0;
      petsc::check(EPSComputeError(eps, i, EPS_ERROR_RELATIVE, &error));
      EXPECT_LT(error, tolerance) << i;
    }
  }
}

/// A matrix that can do nothing but multiply.
TEST(EpsBlockLanczos, TakesAShellMatrixThatOnlyMultiplies)
{
  petsc::Matrix A = laplacian(150), shell;
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatCreateShell(PETSC_COMM_WORLD, n_local, n_local, 150, 150, static_cast<Mat>(A),
                              shell.put()));
  const auto multiply = [](Mat S, Vec x, Vec y) -> PetscErrorCode {
    void* inside = nullptr;
    if (const PetscErrorCode code = MatShellGetContext(S, static_cast<void*>(&inside))) return code;
    return MatMult(static_cast<Mat>(inside), x, y);
  };
  petsc::check(MatShellSetOperation(
      shell, MATOP_MULT,
      reinterpret_cast<void (*)()>(static_cast<PetscErrorCode (*)(Mat, Vec, Vec)>(multiply))));
  std::vector<double> exact = laplacian_spectrum(150);
  std::ranges::reverse(exact);
  expect_first(solver(shell, nullptr, {.nev = 5, .inverts = false}), exact);
}

/// From the point that the user names, as far as possible: the upper end first.
TEST(EpsBlockLanczos, TakesTheOrderOfTheUser)
{
  const petsc::Matrix A = laplacian(150);
  double from = 1.0;
  const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 5, .inverts = false});
  petsc::check(EPSSetEigenvalueComparison(
      eps,
      [](PetscScalar a, PetscScalar, PetscScalar b, PetscScalar, PetscInt* order,
         void* point) -> PetscErrorCode {
        const double to_a = std::abs(a - *static_cast<double*>(point));
        const double to_b = std::abs(b - *static_cast<double*>(point));
        *order = to_a > to_b ? -1 : to_a < to_b ? 1 : 0;
        return 0;
      },
      &from));
  std::vector<double> exact = laplacian_spectrum(150);
  std::ranges::reverse(exact);
  expect_first(eps, exact);
}

/// B^-1 A is symmetric in the inner product of B, which the user gives to the basis.
TEST(EpsBlockLanczos, ObeysAnInnerProductThatIsSetAfterItsSetUp)
{
  constexpr PetscInt n = 200;
  const auto mass = [](PetscInt i) { return 1.0 + 0.5 * std::sin(double(i)); };
  const petsc::Matrix B = diagonal(n, mass);
  const petsc::Matrix S = matrix(n, 3, [&](PetscInt i) {
    Row row{{i, 2.0 / mass(i)}};
    if (i > 0) row.emplace_back(i - 1, -1.0 / mass(i));
    if (i < n - 1) row.emplace_back(i + 1, -1.0 / mass(i));
    return row;
  });
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(n, n);  // B^-1/2 A B^-1/2
  for (PetscInt i = 0; i < n; ++i) {
    scaled(i, i) = 2.0 / mass(i);
    if (i > 0) scaled(i, i - 1) = scaled(i - 1, i) = -1.0 / std::sqrt(mass(i) * mass(i - 1));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact(scaled);
  const petsc::EigenSolver eps = solver(S, nullptr, {.nev = 5, .inverts = false});
  petsc::check(EPSSetUp(eps));
  BV V = nullptr;
  petsc::check(EPSGetBV(eps, &V));
  petsc::check(BVSetMatrix(V, B, PETSC_FALSE));
  petsc::check(EPSSolve(eps));
  const std::vector<double> found = converged(eps);
  ASSERT_GE(std::ssize(found), 5);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(found[i], exact.eigenvalues()[n - 1 - PetscInt(i)], 1e-9) << i;
}

TEST(EpsBlockLanczos, TakesBOfOtherTypes)
{
  constexpr PetscInt n = 120;
  const petsc::Matrix A = diagonal(n, [](PetscInt i) { return 1.0 + i; });
  const petsc::Matrix B = diagonal(n, [](PetscInt) { return 2.0; });
  std::vector<double> exact;
  for (PetscInt i = 0; i < n; ++i) exact.push_back(0.5 * (1.0 + i));
  for (const MatType type : {MATBAIJ, MATSBAIJ, MATAIJPERM, MATAIJSELL}) {
    SCOPED_TRACE(type);
    petsc::Matrix other;
    petsc::check(MatConvert(B, type, MAT_INITIAL_MATRIX, other.put()));
    petsc::check(MatSetOption(other, MAT_SYMMETRIC, PETSC_TRUE));
    expect_first(solver(A, other, {.nev = 6}), exact);
  }
}

/// The eigenvectors first .. last - 1 of a chain between fixed ends.
std::vector<Vec> chain_modes(Mat A, PetscInt first, PetscInt last)
{
  std::vector<Vec> modes;
  for (PetscInt k = first; k < last; ++k) {
    Vec v = nullptr;
    PetscInt n = 0, begin = 0, end = 0;
    petsc::check(MatCreateVecs(A, &v, nullptr));
    petsc::check(VecGetSize(v, &n));
    petsc::check(VecGetOwnershipRange(v, &begin, &end));
    for (PetscInt i = begin; i < end; ++i) {
      const double angle = double(k + 1) * double(i + 1) * std::numbers::pi / double(n + 1);
      petsc::check(VecSetValue(v, i, std::sin(angle), INSERT_VALUES));
    }
    petsc::check(VecAssemblyBegin(v));
    petsc::check(VecAssemblyEnd(v));
    modes.push_back(v);
  }
  return modes;
}

TEST(EpsBlockLanczos, TakesAnInitialSpaceAndIsNotMisledByIt)
{
  constexpr PetscInt n = 400;
  const petsc::Matrix A = matrix(n, 3, [](PetscInt i) {
    Row row{{i, 2.0}};
    if (i > 0) row.emplace_back(i - 1, -1.0);
    if (i < n - 1) row.emplace_back(i + 1, -1.0);
    return row;
  });
  std::vector<double> exact;
  for (PetscInt k = 1; k <= n; ++k)
    exact.push_back(4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / (n + 1)), 2));
  const double target = 0.5 * (exact[11] + exact[12]);
  std::vector<double> nearest = exact;
  std::ranges::sort(nearest, std::less<>(), [&](double x) { return std::abs(x - target); });
  const auto n_steps = [&](PetscInt first, PetscInt last) {
    const petsc::EigenSolver eps = solver(A, nullptr, {.nev = 6, .target = target});
    std::vector<Vec> guesses = chain_modes(A, first, last);
    petsc::check(EPSSetInitialSpace(eps, last - first, guesses.data()));
    expect_first(eps, nearest);
    for (Vec& v : guesses) petsc::check(VecDestroy(&v));
    PetscInt steps = 0;
    petsc::check(EPSGetIterationNumber(eps, &steps));
    return steps;
  };
  const PetscInt without = n_steps(0, 0);
  EXPECT_LT(n_steps(9, 15), without);  // the wanted ones
  n_steps(0, 6);                       // others
  n_steps(2, 22);                      // more than a block
}

}  // namespace
}  // namespace chladni::reduce
