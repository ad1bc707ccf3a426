#include "linear/cholesky/petsc_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <numeric>
#include <string>

#include "chain.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/orthonormalisation.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

using testing::finish;

/// Stiffness of an n x n membrane between fixed edges, two DOFs per node that do not interact.
petsc::Matrix membranes(PetscInt n)
{
  petsc::Matrix A;
  petsc::check(MatCreate(PETSC_COMM_WORLD, A.put()));
  petsc::check(MatSetSizes(A, PETSC_DECIDE, PETSC_DECIDE, 2 * n * n, 2 * n * n));
  petsc::check(MatSetBlockSize(A, 2));
  petsc::check(MatSetType(A, MATAIJ));
  petsc::check(MatSetUp(A));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt row = first; row < last; ++row) {
    const PetscInt i = row / 2 % n, j = row / 2 / n;
    const auto add = [&](bool inside, PetscInt column, double value) {
      if (inside) petsc::check(MatSetValue(A, row, column, value, INSERT_VALUES));
    };
    add(true, row, 4.0);
    add(i > 0, row - 2, -1.0);
    add(i < n - 1, row + 2, -1.0);
    add(j > 0, row - 2 * n, -1.0);
    add(j < n - 1, row + 2 * n, -1.0);
  }
  finish(A);
  return A;
}

/// Column j of row i holds 1 / (1 + i + 3 j), so that no two columns are alike.
petsc::Matrix columns(Mat A, PetscInt n_columns)
{
  petsc::Matrix X = uninitialized_dense(A, n_columns);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n_columns; ++j)
      petsc::check(MatSetValue(X, i, j, 1.0 / (1.0 + i + 3.0 * j), INSERT_VALUES));
  finish(X);
  return X;
}

/// max |X - Y| over max |Y|
double difference(Mat X, Mat Y)
{
  petsc::Matrix D;
  PetscReal norm_D = 0.0, norm_Y = 0.0;
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, D.put()));
  petsc::check(MatAXPY(D, -1.0, Y, SAME_NONZERO_PATTERN));
  petsc::check(MatNorm(D, NORM_FROBENIUS, &norm_D));
  petsc::check(MatNorm(Y, NORM_FROBENIUS, &norm_Y));
  return norm_D / norm_Y;
}

constexpr double round_off = 1e-12;  // condition 4 n^2 / pi^2 = 160 for n = 20, times eps

TEST(EliminationOrder, IsAPermutationThatKeepsTheRowsOfABlockTogether)
{
  const petsc::Matrix A = membranes(20);
  const std::vector<int> places = elimination_order(A);
  if (petsc::rank(PETSC_COMM_WORLD) != 0) {
    EXPECT_TRUE(places.empty());
    return;
  }
  std::vector<int> sorted = places, all(800);
  std::ranges::sort(sorted);
  std::iota(all.begin(), all.end(), 1);
  EXPECT_EQ(sorted, all);
  for (std::size_t i = 0; i < places.size(); i += 2) EXPECT_EQ(places[i + 1], places[i] + 1);
}

TEST(EliminationOrder, TakesAMatrixWithoutBlocksAndWithoutEdges)
{
  const testing::Chain chain = testing::free_chain(7);
  const std::vector<int> of_chain = elimination_order(chain.K);
  const std::vector<int> of_diagonal = elimination_order(chain.M);
  const std::size_t n = petsc::rank(PETSC_COMM_WORLD) == 0 ? 7 : 0;
  EXPECT_EQ(of_chain.size(), n);
  EXPECT_EQ(of_diagonal.size(), n);
}

/// A chain whose springs beyond the nearest neighbours are zeros that were dropped on one side
/// only: those of the elements of a straight beam.
petsc::Matrix chain_with_one_sided_zeros(PetscInt n)
{
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 12, nullptr, 12,
                            nullptr, A.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt row = first; row < last; ++row) {
    const auto set = [&](PetscInt column, double value) {
      if (column < 0 || column >= n) return;
      petsc::check(MatSetValue(A, row, column, value, INSERT_VALUES));
    };
    set(row, 2.1);
    set(row - 1, -1.0);
    set(row + 1, -1.0);
    for (PetscInt reach = 2; reach < 6; ++reach) {
      if ((row + reach) % 3 == 0) set(row + reach, 0.0);
      if ((row * reach) % 5 == 0) set(row - reach, 0.0);
    }
  }
  finish(A);
  return A;
}

TEST(EliminationOrder, TakesAPatternThatIsNotSymmetric)
{
  for (const PetscInt n : {160, 200, 400, 2000}) {
    std::vector<int> places = elimination_order(chain_with_one_sided_zeros(n));
    if (petsc::rank(PETSC_COMM_WORLD) != 0) continue;
    std::vector<int> all(n);
    std::ranges::sort(places);
    std::iota(all.begin(), all.end(), 1);
    EXPECT_EQ(places, all);
  }
}

/// A factorisation of each of our types.
class CholeskyType : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override
  {
    petsc::check(PetscOptionsSetValue(nullptr, "-cms_pc_factor_mat_solver_type", GetParam()));
  }
  void TearDown() override
  {
    petsc::check(PetscOptionsClearValue(nullptr, "-cms_pc_factor_mat_solver_type"));
  }
};

INSTANTIATE_TEST_SUITE_P(Ours, CholeskyType, ::testing::Values(supernodal, mumps_metis),
                         [](const auto& type) {
                           return std::string(type.param == std::string(supernodal) ? "Supernodal"
                                                                                    : "MumpsMetis");
                         });

TEST_P(CholeskyType, SolvesABlockOfColumns)
{
  const petsc::Matrix A = membranes(20);
  const Factorization factorization(A);
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(factorization.factor(), &type));
  EXPECT_STREQ(type, GetParam());
  const petsc::Matrix X = columns(A, 5);
  petsc::Matrix B = uninitialized_dense(A, 5), solution = uninitialized_dense(A, 5);
  SparseProduct(A).apply(X, B);
  petsc::check(MatMatSolve(factorization.factor(), B, solution));
  EXPECT_LT(difference(solution, X), round_off);
}

TEST_P(CholeskyType, GivesTheFormOfTheInverse)
{
  const petsc::Matrix A = membranes(20);
  const Factorization factorization(A);
  petsc::Matrix B = columns(A, 5), solution = uninitialized_dense(A, 5);
  petsc::check(MatMatSolve(factorization.factor(), B, solution));
  const Eigen::MatrixXd expected = inner_product(B, solution);
  const InverseForm form = inverse_form(factorization.factor(), std::move(B));
  const Eigen::MatrixXd found = inner_product(form.left, form.right());
  EXPECT_LT((found - expected).norm(), round_off * expected.norm());
}

TEST_P(CholeskyType, SolvesWhereZerosStandOnOneSideOnly)
{
  for (const PetscInt n : {160, 200, 400, 2000}) {
    const petsc::Matrix A = chain_with_one_sided_zeros(n);
    const Factorization factorization(A);
    const petsc::Matrix X = columns(A, 5);
    petsc::Matrix B = uninitialized_dense(A, 5), solution = uninitialized_dense(A, 5);
    SparseProduct(A).apply(X, B);
    petsc::check(MatMatSolve(factorization.factor(), B, solution));
    EXPECT_LT(difference(solution, X), round_off) << n;  // condition 41
  }
}

TEST_P(CholeskyType, SolvesSparseRightHandSidesOfWhichSomeAreEmpty)
{
  const petsc::Matrix A = membranes(20);
  const Factorization factorization(A);
  constexpr PetscInt n_columns = 150;  // more than one block of 64
  petsc::Matrix Bt, solution = uninitialized_dense(A, n_columns), dense_B;
  PetscInt n_local = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, n_local, n_columns, 800, 2, nullptr, 2,
                            nullptr, Bt.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(Bt, &first, &last));
  for (PetscInt j = first; j < last; ++j) {
    if (j % 7 == 3) continue;
    petsc::check(MatSetValue(Bt, j, 5 * j, 1.0 + j, INSERT_VALUES));
    petsc::check(MatSetValue(Bt, j, 799 - j, -2.0, INSERT_VALUES));
  }
  finish(Bt);
  petsc::check(MatMatTransposeSolve(factorization.factor(), Bt, solution));
  petsc::Matrix product = uninitialized_dense(A, n_columns), B;
  SparseProduct(A).apply(solution, product);
  petsc::check(MatTranspose(Bt, MAT_INITIAL_MATRIX, B.put()));
  petsc::check(MatConvert(B, MATDENSE, MAT_INITIAL_MATRIX, dense_B.put()));
  EXPECT_LT(difference(product, dense_B), round_off);
}

/// A factor of A by our type as any program asks for it, and what it was analysed for.
struct AnyFactor {
  petsc::Matrix F;

  AnyFactor(Mat A, const char* type)
  {
    register_cholesky_types();
    petsc::check(MatGetFactor(A, type, MAT_FACTOR_CHOLESKY, F.put()));
  }
  void factorize(Mat A) const
  {
    petsc::check(MatCholeskyFactorSymbolic(F, A, nullptr, nullptr));
    petsc::check(MatCholeskyFactorNumeric(F, A, nullptr));
  }
  /// |A X - B| / (|A| |X|) of X = A^-1 B.
  double backward_error(Mat A) const
  {
    const petsc::Matrix B = columns(A, 5);
    petsc::Matrix X = uninitialized_dense(A, 5), residual = uninitialized_dense(A, 5);
    petsc::check(MatMatSolve(F, B, X));
    SparseProduct(A).apply(X, residual);
    petsc::check(MatAXPY(residual, -1.0, B, SAME_NONZERO_PATTERN));
    PetscReal of_residual = 0.0, of_A = 0.0, of_X = 0.0;
    petsc::check(MatNorm(residual, NORM_FROBENIUS, &of_residual));
    petsc::check(MatNorm(A, NORM_1, &of_A));
    petsc::check(MatNorm(X, NORM_FROBENIUS, &of_X));
    return of_residual / (of_A * of_X);
  }
};

/// Of a free chain of an odd number of masses, whose eigenvalues 2 - 2 cos(k pi / 801) leave out 2:
/// a condition of 510 there.
petsc::Matrix shifted_chain(double shift)
{
  testing::Chain chain = testing::free_chain(801);
  petsc::check(MatShift(chain.K, -shift));
  return std::move(chain.K);
}

TEST_P(CholeskyType, SolvesIndefiniteMatricesAsWellAsDefiniteOnes)
{
  // The first pivots are 2 - shift: small, zero or negative while the matrix is far from singular.
  for (const double shift : {2.0 - 1e-12, 2.0, 2.0 + 1e-9, 2.0 + 1e-5, 0.7, 3.9}) {
    const petsc::Matrix A = shifted_chain(shift);
    const AnyFactor factor(A, GetParam());
    factor.factorize(A);
    EXPECT_LT(factor.backward_error(A), 1e-14) << shift;
  }
}

/// By Sylvester's law: of the eigenvalues 2 - 2 cos(k pi / 801), k = 0 ... 800, below the shift.
TEST_P(CholeskyType, TellsTheInertiaToAnyCaller)
{
  const petsc::Matrix A = shifted_chain(0.7);
  const AnyFactor factor(A, GetParam());
  factor.factorize(A);
  PetscInt negative = -1, zero = -1, positive = -1, alone = -1;
  petsc::check(MatGetInertia(factor.F, &negative, &zero, &positive));
  petsc::check(MatGetInertia(factor.F, &alone, nullptr, nullptr));
  const int below = 1 + static_cast<int>(801.0 * std::acos(1.0 - 0.35) / std::numbers::pi);
  EXPECT_EQ(negative, below);
  EXPECT_EQ(alone, below);
  EXPECT_EQ(zero, 0);
  EXPECT_EQ(positive, 801 - below);
}

TEST_P(CholeskyType, SaysWhatItIsToAViewer)
{
  const petsc::Matrix A = membranes(20);
  const AnyFactor factor(A, GetParam());
  factor.factorize(A);
  const std::string path = ::testing::TempDir() + "factor_" + GetParam() + ".txt";
  PetscViewer viewer = nullptr;
  petsc::check(PetscViewerASCIIOpen(PETSC_COMM_WORLD, path.c_str(), &viewer));
  petsc::check(PetscViewerPushFormat(viewer, PETSC_VIEWER_ASCII_INFO));
  petsc::check(MatView(factor.F, viewer));
  petsc::check(PetscViewerDestroy(&viewer));
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  EXPECT_NE(text.find(" operations, "), std::string::npos) << text;
}

PivotSigns pivot_signs_of_chain(double shift)
{
  const petsc::Matrix A = shifted_chain(shift);
  petsc::Vector size;
  petsc::check(MatCreateVecs(A, size.put(), nullptr));
  petsc::check(VecSet(size, 2.0 + std::abs(shift)));  // of the middle masses
  SupernodalFactor factor(PETSC_COMM_WORLD);
  factor.analyze(A);
  return factor.pivot_signs(A, size);
}

/// A dense matrix is one front, which stands in memory as L with D and as L D while it is stored.
TEST(SupernodalFactor, ForecastsTheFrontOfADenseMatrixTwiceBesideItsEntries)
{
  if (petsc::size(PETSC_COMM_WORLD) > 1) GTEST_SKIP() << "ranks share the front";
  constexpr PetscInt n = 96;
  const petsc::Matrix A = testing::matrix(n, n, [](PetscInt i) {
    testing::Row row;
    for (PetscInt j = 0; j < n; ++j) row.emplace_back(j, i == j ? 2.0 * n : 1.0);
    return row;
  });
  SupernodalFactor factor(PETSC_COMM_WORLD);
  factor.analyze(A);
  const CholeskyFactor::Memory need = factor.forecast();
  const double front_MiB = double(n) * n * sizeof(double) / 1048576.0;
  EXPECT_NEAR(need.factorization_MiB - need.entries_MiB, 2.0 * front_MiB, 1e-9 * front_MiB);
  EXPECT_DOUBLE_EQ(factor.size().entries, 0.5 * n * (n + 1));
  // Tiles of six rows have the triangle and what fills them up.
  EXPECT_GT(need.entries_MiB, 0.5 * front_MiB);
  EXPECT_LT(need.entries_MiB, 0.5 * front_MiB * (1.0 + 8.0 / n));
}

TEST(PivotSigns, TellTheInertiaAndWhatItIsWorth)
{
  const PivotSigns definite = pivot_signs_of_chain(-0.1);
  EXPECT_EQ(definite.n_negative, 0);
  EXPECT_NEAR(definite.growth, 1.0, 1e-12);  // sum_j L_ij^2 D_jj = A_ii
  const PivotSigns negative = pivot_signs_of_chain(4.5);
  EXPECT_EQ(negative.n_negative, 801);
  EXPECT_LE(negative.growth, 1.0);
  EXPECT_EQ(pivot_signs_of_chain(2.0 + 1e-3).n_negative, 401);
  EXPECT_GT(pivot_signs_of_chain(2.0 + 1e-9).growth, 1e8);
  EXPECT_TRUE(std::isinf(pivot_signs_of_chain(2.0).growth));
}

TEST_P(CholeskyType, SolvesNegativeDefiniteMatrices)
{
  const petsc::Matrix A = shifted_chain(4.5);
  const AnyFactor factor(A, GetParam());
  factor.factorize(A);
  EXPECT_LT(factor.backward_error(A), 1e-14);
  EXPECT_EQ(our_negative_pivots(factor.F), 801);
}

TEST_P(CholeskyType, ReturnsFromAnIndefiniteMatrixToADefiniteOne)
{
  const petsc::Matrix A = shifted_chain(2.0), B = shifted_chain(-0.1);
  const AnyFactor factor(A, GetParam());
  for (const Mat matrix : {Mat(A), Mat(B), Mat(A)}) {
    petsc::check(MatCholeskyFactorSymbolic(factor.F, B, nullptr, nullptr));
    petsc::check(MatCholeskyFactorNumeric(factor.F, matrix, nullptr));  // other values
    EXPECT_LT(factor.backward_error(matrix), 1e-14);
  }
}

TEST_P(CholeskyType, RefusesAnIndefiniteMatrixWhereItMustBeDefinite)
{
  try {
    const Factorization factorization(shifted_chain(1.3));
    ADD_FAILURE() << "accepted";
  } catch (const FreeMotion& error) {
    EXPECT_NE(std::string(error.what()).find("negative pivots"), std::string::npos) << error.what();
  }
}

TEST_P(CholeskyType, IsAnalysedAnewForADenserMatrix)
{
  const testing::Chain chain = testing::free_chain(800);  // M = I
  const petsc::Matrix dense = membranes(20);
  const AnyFactor factor(chain.M, GetParam());
  for (const Mat A : {Mat(chain.M), Mat(dense), Mat(chain.M)}) {
    factor.factorize(A);
    EXPECT_LT(factor.backward_error(A), 1e-14);
  }
}

TEST(CholeskyTypes, RefuseEntriesThatTheAnalysisDidNotSee)
{
  const testing::Chain chain = testing::free_chain(800);
  const petsc::Matrix dense = membranes(20);
  const AnyFactor factor(chain.M, supernodal);
  petsc::check(MatCholeskyFactorSymbolic(factor.F, chain.M, nullptr, nullptr));
  petsc::check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
  EXPECT_NE(MatCholeskyFactorNumeric(factor.F, dense, nullptr), 0);
  petsc::check(PetscPopErrorHandler());
}

TEST_P(CholeskyType, RefusesAFactorBeyondTheMemoryAllowed)
{
  const petsc::Matrix A = membranes(20);
  try {
    const Factorization factorization(A, {.factor = {.memory_MiB = 1.0, .beside_MiB = 2.0}});
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("alone need more than there is"), std::string::npos)
        << error.what();
  }
}

TEST_P(CholeskyType, TakesIntoAccountWhatEachRankTakesBeside)
{
  const petsc::Matrix A = membranes(20);
  const int n_ranks = petsc::size(PETSC_COMM_WORLD);  // all of them on this machine
  for (const double beside_MiB : {100.0, 400.0}) {
    const FactorOptions options{.memory_MiB = 250.0 * n_ranks, .beside_MiB = beside_MiB};
    try {
      const Factorization factorization(A, {.factor = options});
      EXPECT_LT(beside_MiB, 250.0) << "accepted";
    } catch (const Error& error) {
      EXPECT_GT(beside_MiB, 250.0) << error.what();
    }
  }
}

/// The machine where most is lacking counts, not the fullest one.
TEST(MachineMemory, IsThatOfTheTightestMachine)
{
  const double n_ranks = petsc::size(PETSC_COMM_WORLD);
  const MemoryNeed enough = tightest_machine(10.0, 10.0 * n_ranks, PETSC_COMM_WORLD);
  EXPECT_DOUBLE_EQ(enough.needed_MiB, 10.0 * n_ranks);
  EXPECT_TRUE(enough.fits());
  const bool is_last = petsc::rank(PETSC_COMM_WORLD) + 1 == petsc::size(PETSC_COMM_WORLD);
  const MemoryNeed tight =
      tightest_machine(10.0, is_last ? 9.0 : 100.0, PETSC_COMM_WORLD);  // as if machines differed
  EXPECT_DOUBLE_EQ(tight.free_MiB, 9.0);
  EXPECT_FALSE(tight.fits());
  EXPECT_THROW(require_memory(1e15, "this", "take less", PETSC_COMM_WORLD), Error);
}

TEST_P(CholeskyType, AgreesWithPetscsOwnInterface)
{
  const petsc::Matrix A = membranes(20);
  const petsc::Matrix B = columns(A, 3);
  petsc::Matrix X = uninitialized_dense(A, 3), Y = uninitialized_dense(A, 3);
  petsc::check(MatMatSolve(Factorization(A).factor(), B, X));
  petsc::check(PetscOptionsSetValue(nullptr, "-cms_pc_factor_mat_solver_type", "mumps"));
  petsc::check(MatMatSolve(Factorization(A).factor(), B, Y));
  petsc::check(PetscOptionsClearValue(nullptr, "-cms_pc_factor_mat_solver_type"));
  EXPECT_LT(difference(X, Y), round_off);
}

TEST(CholeskyTypes, ObeyADatabaseOfTheirOwn)
{
  const petsc::Matrix A = membranes(20);
  for (const std::string type : {"mumps", "mumps-metis"}) {
    PetscOptions own = nullptr;
    petsc::check(PetscOptionsCreate(&own));
    petsc::check(PetscOptionsInsertString(
        own, ("-left_pc_factor_mat_solver_type " + type + " -left_mat_mumps_icntl_14 77").c_str()));
    const Factorization factorization(A, {.petsc = {.database = own, .prefix = "left_"}});
    MatSolverType found = nullptr;
    PetscInt percent = 0;
    petsc::check(MatFactorGetSolverType(factorization.factor(), &found));
    petsc::check(MatMumpsGetIcntl(factorization.factor(), 14, &percent));
    EXPECT_EQ(found, type);
    EXPECT_EQ(percent, 77);
    petsc::check(PetscOptionsDestroy(&own));
  }
}

TEST(CholeskyTypes, AreTheOnlyPreconditionersThatWillDo)
{
  const petsc::Matrix A = membranes(4);
  for (const char* type : {"lu", "jacobi", "qr"}) {
    petsc::check(PetscOptionsSetValue(nullptr, "-cms_pc_type", type));
    try {
      const Factorization factorization(A);
      ADD_FAILURE() << type << " is accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("-cms_pc_type ") + type),
                std::string::npos)
          << error.what();
    }
    petsc::check(PetscOptionsClearValue(nullptr, "-cms_pc_type"));
  }
}

TEST(CholeskyTypes, TakeTheSupernodalOneWithoutAnOption)
{
  const petsc::Matrix A = membranes(4);
  const Factorization factorization(A);
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(factorization.factor(), &type));
  EXPECT_STREQ(type, supernodal);
}

/// One column narrower than, as wide as, and wider than the panels.
class SparseProductOf : public ::testing::TestWithParam<PetscInt> {};

TEST_P(SparseProductOf, EqualsPetscs)
{
  const petsc::Matrix A = membranes(20);
  const petsc::Matrix X = columns(A, GetParam());
  petsc::Matrix Y = uninitialized_dense(A, GetParam()), by_PETSc;
  SparseProduct(A).apply(X, Y);
  petsc::check(MatMatMult(A, X, MAT_INITIAL_MATRIX, petsc::automatic, by_PETSc.put()));
  EXPECT_LT(difference(Y, by_PETSc), 1e-15);  // five terms each
}

TEST(SparseProduct, TakesTheVariantsOfAij)
{
  const petsc::Matrix A = membranes(20);
  const petsc::Matrix X = columns(A, 3);
  petsc::Matrix Y = uninitialized_dense(A, 3), Z = uninitialized_dense(A, 3);
  SparseProduct(A).apply(X, Y);
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  for (const char* type : {MATAIJPERM, MATAIJSELL, MATBAIJ, MATSBAIJ}) {
    petsc::Matrix B;
    petsc::check(MatConvert(A, type, MAT_INITIAL_MATRIX, B.put()));
    SparseProduct(B).apply(X, Z);
    EXPECT_EQ(difference(Y, Z), 0.0) << type;
  }
}

TEST(SparseProduct, TakesAMatrixOfOtherColumnsThanRows)
{
  const petsc::Matrix A = membranes(20);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  petsc::IndexSet rows, columns;
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, (last - first) / 2, first, 2, rows.put()));
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, (last - first) / 3, first + 1, 3, columns.put()));
  petsc::Matrix B, square, by_petsc;
  petsc::check(MatCreateSubMatrix(A, rows, columns, MAT_INITIAL_MATRIX, B.put()));
  petsc::check(MatCreateSubMatrix(A, columns, columns, MAT_INITIAL_MATRIX, square.put()));
  const petsc::Matrix X = uninitialized_dense(square, 21), Y = uninitialized_dense(B, 21);
  fill_with_random_numbers(X, 0);
  SparseProduct(B).apply(X, Y);
  petsc::check(MatMatMult(B, X, MAT_INITIAL_MATRIX, petsc::automatic, by_petsc.put()));
  PetscReal size = 0.0;
  petsc::check(MatNorm(by_petsc, NORM_FROBENIUS, &size));
  EXPECT_GT(size, 1.0);
  EXPECT_LT(difference(by_petsc, Y), 1e-14 * size);
}

INSTANTIATE_TEST_SUITE_P(Widths, SparseProductOf, ::testing::Values(1, 8, 9, 16, 17, 40));

}  // namespace
}  // namespace chladni::linear
