#include "linear/kernels/decoupled_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/forms.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

/// Chains between fixed ends that lie into each other: row i belongs to chain i % n_chains.
petsc::Matrix chains(PetscInt n_rows, PetscInt n_chains)
{
  return testing::matrix(n_rows, 3, [&](PetscInt i) {
    testing::Row row{{i, 2.1}};
    if (i >= n_chains) row.emplace_back(i - n_chains, -1.0);
    if (i + n_chains < n_rows) row.emplace_back(i + n_chains, -1.0);
    return row;
  });
}

/// A diagonal, and one entry between two rows.
petsc::Matrix diagonal_and_entry(PetscInt n_rows, PetscInt a, PetscInt b)
{
  return testing::matrix(n_rows, 2, [&](PetscInt i) {
    testing::Row row{{i, 1.0}};
    if (a != b && i == a) row.emplace_back(b, 0.1);
    if (a != b && i == b) row.emplace_back(a, 0.1);
    return row;
  });
}

std::vector<PetscInt> all_of(IS set)
{
  PetscInt n = 0;
  const PetscInt* rows = nullptr;
  petsc::check(ISGetLocalSize(set, &n));
  petsc::check(ISGetIndices(set, &rows));
  const std::vector<PetscInt> own(rows, rows + n);
  petsc::check(ISRestoreIndices(set, &rows));
  return gather_on_all(own, MPIU_INT, petsc::communicator(set));
}

std::vector<PetscInt> members(PetscInt first, PetscInt step, PetscInt end)
{
  std::vector<PetscInt> rows;
  for (PetscInt i = first; i < end; i += step) rows.push_back(i);
  return rows;
}

TEST(DecoupledRows, AreThoseOfEachChain)
{
  const petsc::Matrix K = chains(301, 2);
  const auto sets = decoupled_rows(K, diagonal_and_entry(301, 0, 0));
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(all_of(sets[0]), members(0, 2, 301));  // the longer one
  EXPECT_EQ(all_of(sets[1]), members(1, 2, 301));
}

TEST(DecoupledRows, AreNoneWhereOneEntryOfTheMassCouplesTheChains)
{
  const petsc::Matrix K = chains(301, 2);
  EXPECT_TRUE(decoupled_rows(K, diagonal_and_entry(301, 0, 299)).empty());
  EXPECT_TRUE(decoupled_rows(K, diagonal_and_entry(301, 7, 8)).empty());
}

TEST(DecoupledRows, AreUnitedWhereTheyAreSmall)
{
  EXPECT_TRUE(decoupled_rows(diagonal_and_entry(300, 0, 0), diagonal_and_entry(300, 0, 0)).empty());
  EXPECT_TRUE(decoupled_rows(chains(300, 40), diagonal_and_entry(300, 0, 0)).empty());
}

TEST(DecoupledRows, LeaveWhatIsSmallForTheLastSet)
{
  const petsc::Matrix K = testing::matrix(301, 5, [&](PetscInt i) {
    testing::Row row{{i, 4.1}};
    if (i % 50 == 17) return row;  // alone
    const auto join = [&](PetscInt j) {
      if (j >= 0 && j < 301 && j % 50 != 17) row.emplace_back(j, -1.0);
    };
    join(i - 2);
    join(i + 2);
    join(i - 4);
    join(i + 4);
    return row;
  });
  const auto sets = decoupled_rows(K, diagonal_and_entry(301, 0, 0));
  ASSERT_EQ(sets.size(), 3u);
  EXPECT_EQ(all_of(sets[0]), members(0, 2, 301));
  EXPECT_EQ(all_of(sets[2]), members(17, 50, 301));
}

TEST(DecoupledRows, BelongTogetherWhereARankHasAlmostNothingOfASet)
{
  const petsc::Matrix K = testing::matrix(300, 3, [](PetscInt i) {  // halves, one after the other
    testing::Row row{{i, 2.1}};
    if (i % 150 > 0) row.emplace_back(i - 1, -1.0);
    if (i % 150 < 149) row.emplace_back(i + 1, -1.0);
    return row;
  });
  const bool is_alone = petsc::size(PETSC_COMM_WORLD) == 1;
  const auto sets = decoupled_rows(K, diagonal_and_entry(300, 0, 0));
  EXPECT_TRUE(!is_alone || sets.size() == 2) << sets.size();
  // Of two ranks each has a half: by themselves they would have one wait for the other.
  for (const petsc::IndexSet& set : sets) {
    PetscInt n = 0, n_local = 0;
    petsc::check(ISGetSize(set, &n));
    petsc::check(ISGetLocalSize(set, &n_local));
    EXPECT_LE(2 * n_local * petsc::size(PETSC_COMM_WORLD), 3 * n);
  }
}

/// Columns of which each has entries in one chain of three only, but every fifth in all of them.
petsc::Matrix columns_of_chains(Mat A, PetscInt n_columns)
{
  petsc::Matrix X = uninitialized_dense(A, n_columns);
  petsc::check(MatZeroEntries(X));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n_columns; ++j)
      if (j % 5 == 0 || i % 3 == j % 3)
        petsc::check(MatSetValue(X, i, j, 1.0 / (1.0 + i % 17 + 3.0 * j), INSERT_VALUES));
  testing::finish(X);
  return X;
}

TEST(PartedForm, IsThatOfTheWhole)
{
  const petsc::Matrix A = chains(301, 3);
  ASSERT_EQ(decoupled_rows(A, A).size(), 3u);
  const petsc::Matrix X = columns_of_chains(A, 80), Y = columns_of_chains(A, 70);
  petsc::Matrix AX = uninitialized_dense(A, 80), AY = uninitialized_dense(A, 70);
  SparseProduct(A).apply(X, AX);
  SparseProduct(A).apply(Y, AY);
  const Eigen::MatrixXd of_both = inner_product(X, AY), of_one = inner_product(X, AX);
  EXPECT_LT((parted_form(X, A, Y) - of_both).norm(), 1e-14 * of_both.norm());
  const auto form_of_X = [&] {
    return parted_form(std::array<Mat, 1>{X}, A, FormSymmetry::symmetric);
  };
  EXPECT_LT((form_of_X() - of_one).norm(), 1e-14 * of_one.norm());
  EXPECT_EQ(form_of_X(), Eigen::MatrixXd(form_of_X().transpose()));
  Eigen::MatrixXd of_all(150, 150);
  of_all << of_one, of_both, of_both.transpose(), inner_product(Y, AY);
  for (const FormSymmetry symmetry : {FormSymmetry::none, FormSymmetry::symmetric}) {
    const Eigen::MatrixXd F = parted_form(std::array<Mat, 2>{X, Y}, A, symmetry);
    EXPECT_LT((F - of_all).norm(), 1e-14 * of_all.norm());
  }
  const Eigen::MatrixXd leading = leading_columns_of_form(std::array<Mat, 2>{X, Y}, A);
  EXPECT_LT((leading - of_all.leftCols(80)).norm(), 1e-14 * of_all.norm());
  EXPECT_EQ(leading.topRows(80), Eigen::MatrixXd(leading.topRows(80).transpose()));
}

TEST(FormParts, AreOneWhereTheColumnsAreTheSame)
{
  const petsc::Matrix A = chains(301, 3);
  const petsc::Matrix X = columns_of_chains(A, 80);
  petsc::Matrix Y = uninitialized_dense(A, 7);  // without entries in the third chain
  petsc::check(MatZeroEntries(Y));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < 7; ++j)
      if (i % 3 != 2) petsc::check(MatSetValue(Y, i, j, 1.0 + j, INSERT_VALUES));
  testing::finish(Y);
  EXPECT_EQ(form_parts(A, std::array<Mat, 1>{X}).size(), 3u);
  const std::vector<FormPart> parts = form_parts(A, std::array<Mat, 1>{Y});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].columns[0].size(), 7u);
  EXPECT_TRUE(parts[1].columns[0].empty());
  EXPECT_TRUE(std::ranges::is_sorted(parts[0].rows));
}

TEST(PartedForm, KnowsEntriesOnOneSideOfTheDiagonalAndRowsWithoutAny)
{
  constexpr PetscInt n = 302;
  const petsc::Matrix A = testing::matrix(n, 2, [&](PetscInt i) {
    testing::Row row;
    if (i % 3 == 0 && i + 1 < n) row.emplace_back(i + 1, 1.5);
    if (i % 3 == 0 && i >= 2) row.emplace_back(i - 2, -0.5);
    return row;
  });
  const petsc::Matrix X = columns_of_chains(A, 80), Y = columns_of_chains(A, 70);
  petsc::Matrix AX = uninitialized_dense(A, 80), AY = uninitialized_dense(A, 70);
  SparseProduct(A).apply(X, AX);
  SparseProduct(A).apply(Y, AY);
  Eigen::MatrixXd whole(150, 150);
  whole << inner_product(X, AX), inner_product(X, AY), inner_product(Y, AX), inner_product(Y, AY);
  const Eigen::MatrixXd F = parted_form(std::array<Mat, 2>{X, Y}, A, FormSymmetry::none);
  EXPECT_LT((F - whole).norm(), 1e-14 * whole.norm());
  EXPECT_GT((F - F.transpose()).norm(), 0.1 * whole.norm());
}

TEST(PartSolver, SolvesForThePartAsTheWholeDoes)
{
  const PetscInt n = 301, n_columns = 11;
  const petsc::Matrix K = chains(n, 3);
  const Factorization factorization(K);
  ASSERT_TRUE(solves_for_parts(factorization.factor()));
  const auto sets = decoupled_rows(K, diagonal_and_entry(n, 0, 0));
  ASSERT_EQ(sets.size(), 3u);
  petsc::Matrix X = uninitialized_dense(K, n_columns);
  const auto fill = [](Mat B, IS rows) {
    const std::vector<PetscInt> all = all_of(rows);
    PetscInt first = 0, last = 0;
    petsc::check(MatGetOwnershipRange(B, &first, &last));
    for (PetscInt i = first; i < last; ++i)
      for (PetscInt j = 0; j < 11; ++j)
        petsc::check(MatSetValue(B, i, j, 1.0 / (1.0 + all[i] + 3.0 * j), INSERT_VALUES));
    testing::finish(B);
  };
  petsc::IndexSet every_row;
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, last - first, first, 1, every_row.put()));
  fill(X, every_row);
  petsc::check(MatMatSolve(factorization.factor(), X, X));
  const LocalRows whole(X);
  for (const petsc::IndexSet& set : sets) {
    petsc::Matrix K_part;
    petsc::check(MatCreateSubMatrix(K, set, set, MAT_INITIAL_MATRIX, K_part.put()));
    petsc::Matrix B = uninitialized_dense(K_part, n_columns),
                  Y = uninitialized_dense(K_part, n_columns);
    fill(B, set);
    part_solver(factorization.factor(), set)(B, Y);
    const LocalRows part(Y);
    const PetscInt* rows = nullptr;
    petsc::check(ISGetIndices(set, &rows));
    for (PetscInt i = 0; i < part.n_rows(); ++i)
      for (PetscInt j = 0; j < n_columns; ++j)
        EXPECT_NEAR(part(i, j), whole(rows[i] - first, j), 1e-14) << rows[i] << ", " << j;
    petsc::check(ISRestoreIndices(set, &rows));
  }
}

/// A dense matrix with a value for each row and column.
petsc::Matrix dense(Mat A, PetscInt n_columns,
                    const std::function<double(PetscInt, PetscInt)>& value)
{
  petsc::Matrix X = uninitialized_dense(A, n_columns);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < n_columns; ++j)
      petsc::check(MatSetValue(X, i, j, value(i, j), INSERT_VALUES));
  testing::finish(X);
  return X;
}

TEST(Factorization, LeavesPartsAtRestThatNothingLoads)
{
  const PetscInt n = 301;
  const petsc::Matrix K = chains(n, 3);
  const Factorization factorization(K);
  const petsc::Matrix B = dense(
      K, 11, [](PetscInt i, PetscInt j) { return i % 3 == 1 ? 1.0 / (1.0 + i % 7 + j) : 0.0; });
  const petsc::Matrix X = uninitialized_dense(K, 11);
  petsc::check(MatMatSolve(factorization.factor(), B, X));
  const petsc::Matrix KX = sparse_product(K, X);
  const LocalRows x(X), kx(KX), b(B);
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(K, &first, nullptr));
  for (PetscInt i = 0; i < x.n_rows(); ++i)
    for (PetscInt j = 0; j < 11; ++j) {
      EXPECT_NEAR(kx(i, j), b(i, j), 1e-13);
      if ((first + i) % 3 != 1) {
        EXPECT_EQ(x(i, j), 0.0);
      }
    }
  const Eigen::MatrixXd form = inner_product(B, X);
  petsc::Matrix forces;
  petsc::check(MatDuplicate(B, MAT_COPY_VALUES, forces.put()));
  const InverseForm half = inverse_form(factorization.factor(), std::move(forces));
  EXPECT_LT((inner_product(half.left, half.right()) - form).norm(), 1e-13 * form.norm());
}

TEST(PartSolver, RefusesRowsThatOthersAreCoupledTo)
{
  const petsc::Matrix K = chains(300, 2);
  const Factorization factorization(K);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  petsc::IndexSet some;
  petsc::check(ISCreateStride(PETSC_COMM_WORLD, last - first - 2, first, 1, some.put()));
  EXPECT_THROW(part_solver(factorization.factor(), some), Error);
}

}  // namespace
}  // namespace chladni::linear
