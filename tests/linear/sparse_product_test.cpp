#include "linear/kernels/sparse_product.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/eigen_every.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/kernels/storage.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

using Eigen::MatrixXd;

/// Two halves that are coupled to nothing else, one behind the other, of nodes of three rows with
/// the same columns and, at every fifth one, of one row with fewer.
petsc::Matrix halves(PetscInt n)
{
  return testing::matrix(n, 20, [n](PetscInt i) {
    testing::Row row;
    const PetscInt half = 2 * i < n ? 0 : 1, node = i / 3;
    for (PetscInt j = std::max<PetscInt>(0, 3 * (node - 2)); j < std::min(n, 3 * (node + 3)); ++j) {
      const bool is_left_out = i % 15 == 7 && j % 2 == 0 && i != j;
      const PetscInt its_half = 2 * j < n ? 0 : 1;
      if (its_half == half && !is_left_out) row.emplace_back(j, std::sin(1.0 + double(i * j)));
    }
    return row;
  });
}

/// Columns of both halves, of the first, of the second, and of none.
MatrixXd mixed_columns(PetscInt n, PetscInt n_columns)
{
  MatrixXd X = MatrixXd::Zero(n, n_columns);
  for (PetscInt j = 0; j < n_columns; ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      const int half = 2 * i < n ? 0 : 1;
      if (j % 4 == 0 || (j % 4 == 1 && half == 0) || (j % 4 == 2 && half == 1))
        X(i, j) = std::cos(double(i) + 7.0 * double(j));
    }
  }
  return X;
}

petsc::Matrix on_ranks(Mat A, const MatrixXd& X)
{
  petsc::Matrix dense = uninitialized_dense(A, X.cols());
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (PetscInt j = 0; j < X.cols(); ++j)
      petsc::check(MatSetValue(dense, i, j, X(i, j), INSERT_VALUES));
  testing::finish(dense);
  return dense;
}

/// Instructions of this processor and of lesser ones.
class InLanes : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override
  {
    if (limit_lanes(GetParam()) != GetParam()) GTEST_SKIP() << "not on this processor";
  }
  void TearDown() override { limit_lanes(most); }

 private:
  static constexpr int most = 64;
};

INSTANTIATE_TEST_SUITE_P(Numbers, InLanes, ::testing::Values(2, 4, 8),
                         ::testing::PrintToStringParamName());

TEST_P(InLanes, AProductIsRightForColumnsOfDifferentParts)
{
  constexpr PetscInt n = 180;
  const petsc::Matrix A = halves(n);
  for (const PetscInt n_columns : {1, 4, 8, 9, 16, 37}) {
    const MatrixXd X = mixed_columns(n, n_columns);
    const petsc::Matrix Y = on_ranks(A, MatrixXd::Constant(n, n_columns, 17.0));
    SparseProduct(A).apply(on_ranks(A, X), Y);
    const MatrixXd expected = replicate(A) * X;
    const LocalRows y(Y);
    PetscInt first = 0;
    petsc::check(MatGetOwnershipRange(A, &first, nullptr));
    for (PetscInt i = 0; i < y.n_rows(); ++i)
      for (PetscInt j = 0; j < n_columns; ++j)
        ASSERT_NEAR(y(i, j), expected(first + i, j), 1e-13) << i << " " << j << " of " << n_columns;
  }
}

/// Blocks of three rows that have the same columns, coupled to nothing else.
petsc::Matrix blocks_of_three(PetscInt n)
{
  return testing::matrix(n, 4, [n](PetscInt i) {
    testing::Row row;
    for (PetscInt j = i - i % 3; j < std::min(n, i - i % 3 + 3); ++j)
      row.emplace_back(j, i == j ? 5.0 : 1.0 + double(i + j) / double(n));
    return row;
  });
}

/// Couples the second row of each rank with its last one: rows that were alike are no longer, and
/// parts that nothing coupled are one.
void couple_ends_of_each_rank(Mat A)
{
  petsc::check(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  petsc::check(MatSetValue(A, first + 1, last - 1, 7.0, INSERT_VALUES));
  petsc::check(MatSetValue(A, last - 1, first + 1, 7.0, INSERT_VALUES));
  testing::finish(A);
}

/// Columns that are zero but in the last row of each rank: only what is coupled with it answers.
MatrixXd last_rows_of_ranks(Mat A, PetscInt n_columns)
{
  PetscInt n = 0;
  const PetscInt* ranges = nullptr;
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatGetOwnershipRanges(A, &ranges));
  MatrixXd X = MatrixXd::Zero(n, n_columns);
  for (int rank = 0; rank < petsc::size(petsc::communicator(A)); ++rank)
    for (PetscInt j = 0; j < n_columns; ++j) X(ranges[rank + 1] - 1, j) = 1.0 + double(j);
  return X;
}

TEST(SparseProduct, SeesThatAMatrixGotOtherEntries)
{
  constexpr PetscInt n = 96;  // twelve rows on the last of eight ranks
  const petsc::Matrix I = testing::diagonal(n, [](PetscInt) { return 1.0; });
  const auto all_rows = [&](Mat Y) {
    return inner_product(on_ranks(I, MatrixXd::Identity(n, n)), Y);
  };
  const petsc::Matrix A = blocks_of_three(n);
  const MatrixXd full = MatrixXd::NullaryExpr(n, 9, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.0 + double(i) + 0.7 * double(i * j));  // the same on all ranks
  });
  for (const bool is_coupled : {false, true}) {
    if (is_coupled) couple_ends_of_each_rank(A);
    for (const MatrixXd& X :
         {last_rows_of_ranks(A, 5), last_rows_of_ranks(A, 12), full, mixed_columns(n, 5)}) {
      const MatrixXd found = all_rows(sparse_product(A, on_ranks(A, X)));
      EXPECT_LT((found - replicate(A) * X).norm(), 1e-12 * X.norm()) << is_coupled;
    }
  }
}

TEST(AddProduct, LeavesOutColumnsThatNothingIsTakenOf)
{
  constexpr PetscInt n = 1300;
  const petsc::Matrix A = testing::diagonal(n, [](PetscInt) { return 1.0; });
  const MatrixXd X = mixed_columns(n, 12), Y = mixed_columns(n, 3);
  MatrixXd S = MatrixXd::Zero(12, 3);
  S.row(1) << 1.0, 2.0, 3.0;
  S.row(9) << 4.0, 5.0, 6.0;  // both of the first half
  const petsc::Matrix sum = on_ranks(A, Y);
  add_product(-2.0, on_ranks(A, X), S, sum);
  const LocalRows found(sum);
  const MatrixXd expected = Y - 2.0 * X * S;
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  for (PetscInt i = 0; i < found.n_rows(); ++i)
    for (PetscInt j = 0; j < 3; ++j) ASSERT_NEAR(found(i, j), expected(first + i, j), 1e-14);
}

TEST(LargeDense, IsZero)
{
  const petsc::Matrix A = testing::diagonal(1000, [](PetscInt) { return 1.0; });
  for (const PetscInt n_columns : {1, 300}) {  // on the heap, and mapped
    PetscReal norm = 1.0;
    petsc::check(MatNorm(large_dense(A, n_columns, ""), NORM_INFINITY, &norm));
    EXPECT_EQ(norm, 0.0);
  }
}

TEST_P(InLanes, ColumnsComeBackFromAPanel)
{
  constexpr int n = 43;
  std::vector<int> rows, slots(n);
  for (int i = 0; i < n; ++i) rows.push_back(i < 20 ? i : i + 3);  // not all in line
  std::iota(slots.begin(), slots.end(), 0);
  std::rotate(slots.begin(), slots.begin() + 11, slots.end());
  for (const PetscInt width : {8, 16}) {
    for (const int n_columns : {1, 7, 8, 11, 16}) {
      if (n_columns > width) continue;
      const MatrixXd X = MatrixXd::Random(n + 3, n_columns);
      MatrixXd Y = MatrixXd::Constant(n + 3, n_columns, 5.0);
      std::vector<const double*> from;
      std::vector<double*> to;
      for (int c = 0; c < n_columns; ++c) {
        from.push_back(X.col(c).data());
        to.push_back(Y.col(c).data());
      }
      const PanelRows where{.n = n, .rows = rows.data(), .slots = slots.data()};
      std::vector<double> panel(std::size_t(n) * width, 7.0);
      to_panel(from, where, width, panel.data());
      to_columns(panel.data(), width, where, to);
      EXPECT_EQ(Y(rows, every), X(rows, every));
      EXPECT_EQ(Y.row(21), MatrixXd::Constant(1, n_columns, 5.0));  // which is not asked for
      for (int i = 0; i < n; ++i) {
        const double* row = panel.data() + std::size_t(slots[i]) * width;
        for (int c = 0; c < width; ++c)
          EXPECT_EQ(row[c], c < n_columns ? X(rows[i], c) : 0.0) << i << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace chladni::linear
