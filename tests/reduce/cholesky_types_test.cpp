#include "reduce/cholesky_types.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "chain.hpp"
#include "reduce/dense.hpp"
#include "reduce/elimination_order.hpp"
#include "reduce/factorization.hpp"
#include "reduce/sparse_product.hpp"

namespace chladni::reduce {
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
  for (PetscInt i = first; i < last; ++i) {
    for (PetscInt j = 0; j < n_columns; ++j) {
      petsc::check(MatSetValue(X, i, j, 1.0 / (1.0 + i + 3.0 * j), INSERT_VALUES));
    }
  }
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

TEST_P(CholeskyType, RefusesAFactorBeyondTheMemoryAllowed)
{
  const petsc::Matrix A = membranes(20);
  petsc::check(PetscOptionsSetValue(nullptr, "-cms_memory", "1"));
  try {
    const Factorization factorization(A, 2.0);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("alone need more than there is"), std::string::npos)
        << error.what();
  }
  petsc::check(PetscOptionsClearValue(nullptr, "-cms_memory"));
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
  petsc::check(MatMatMult(A, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, by_PETSc.put()));
  EXPECT_LT(difference(Y, by_PETSc), 1e-15);  // five terms each
}

INSTANTIATE_TEST_SUITE_P(Widths, SparseProductOf, ::testing::Values(1, 8, 9, 16, 17, 40));

}  // namespace
}  // namespace chladni::reduce
