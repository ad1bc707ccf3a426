#include "linear/kernels/sparse_matrices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/gather.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

constexpr PetscInt matrix_order = 40;

/// Entry (i, j) is 100 i + j, so that each tells where it comes from; five diagonals and a far one.
petsc::Matrix numbered()
{
  return testing::matrix(matrix_order, 8, [](PetscInt i) {
    testing::Row row;
    for (const PetscInt j : {i - 2, i - 1, i, i + 1, i + 2, matrix_order - 1 - i})
      if (j >= 0 && j < matrix_order) row.emplace_back(j, 100.0 * i + j);
    return row;
  });
}

petsc::IndexSet set_of(std::vector<PetscInt> rows)
{
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(rows.size()), rows.data(),
                               PETSC_COPY_VALUES, set.put()));
  return set;
}

std::vector<PetscInt> own_rows_of(Mat A)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  std::vector<PetscInt> rows;
  for (PetscInt i = first; i < last; ++i) rows.push_back(i);
  return rows;
}

/// Two thirds of the rows of each rank, in disorder.
petsc::IndexSet some_rows(Mat A)
{
  std::vector<PetscInt> rows = own_rows_of(A);
  std::erase_if(rows, [](PetscInt i) { return i % 3 == 1; });
  std::shuffle(rows.begin(), rows.end(), std::mt19937(5));
  return set_of(rows);
}

TEST(OwnSubmatrix, HasTheEntriesOfItsRowsAndColumnsInTheirOrder)
{
  const petsc::Matrix A = numbered();
  std::vector<PetscInt> backwards = own_rows_of(A);
  std::ranges::reverse(backwards);
  backwards.pop_back();
  const petsc::IndexSet rows = some_rows(A), columns = set_of(backwards);
  const petsc::Matrix block = own_submatrix(A, rows, columns);
  const std::vector<PetscInt> all_columns =
      gather_on_all(petsc::own_indices(columns), MPIU_INT, PETSC_COMM_WORLD);
  const std::vector<PetscInt> own = petsc::own_indices(rows);
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(block, &first, nullptr));
  for (std::size_t i = 0; i < own.size(); ++i) {
    PetscInt n_entries = 0;
    const PetscInt* places = nullptr;
    const PetscScalar* values = nullptr;
    const auto row = static_cast<PetscInt>(first + i);
    petsc::check(MatGetRow(block, row, &n_entries, &places, &values));
    EXPECT_TRUE(std::is_sorted(places, places + n_entries));
    std::vector<PetscInt> found, expected;
    for (PetscInt k = 0; k < n_entries; ++k) {
      const PetscInt column = all_columns[std::size_t(places[k])];
      found.push_back(column);
      EXPECT_EQ(values[k], 100.0 * own[i] + column);
    }
    petsc::check(MatRestoreRow(block, row, &n_entries, &places, &values));
    for (PetscInt j = 0; j < matrix_order; ++j) {
      const bool is_entry = std::abs(own[i] - j) <= 2 || own[i] + j == matrix_order - 1;
      if (is_entry && std::ranges::find(all_columns, j) != all_columns.end()) expected.push_back(j);
    }
    std::ranges::sort(found);
    EXPECT_EQ(found, expected);
  }
}

TEST(OwnSubmatrix, KnowsThatItIsSymmetric)
{
  const petsc::Matrix A = numbered();
  const petsc::IndexSet rows = some_rows(A);
  PetscBool is_known = PETSC_FALSE, is_symmetric = PETSC_FALSE;
  petsc::check(MatIsSymmetricKnown(own_submatrix(A, rows, rows), &is_known, &is_symmetric));
  EXPECT_TRUE(is_known && is_symmetric);
}

/// Chains that lie into each other, and a row with entries in all of them.
petsc::Matrix joined_chains(PetscInt n_rows, PetscInt n_chains)
{
  return testing::matrix(n_rows, n_rows, [&](PetscInt i) {
    testing::Row row{{i, 2.1}};
    if (i == 0)
      for (PetscInt j = 1; j < n_rows; ++j) row.emplace_back(j, -0.01);
    if (i > n_chains) row.emplace_back(i - n_chains, -1.0);
    if (i > 0 && i + n_chains < n_rows) row.emplace_back(i + n_chains, -1.0);
    if (i > 0) row.emplace_back(0, -0.01);
    return row;
  });
}

TEST(DecoupledRows, OfSomeRowsAreThoseOfTheirBlock)
{
  const petsc::Matrix A = joined_chains(121, 2);
  std::vector<PetscInt> kept = own_rows_of(A);
  std::erase(kept, 0);
  const petsc::IndexSet rows = set_of(kept);
  EXPECT_TRUE(decoupled_rows(A, A).empty());
  const auto sets = decoupled_rows(A, A, rows);
  ASSERT_EQ(sets.size(), 2u);
  for (const petsc::IndexSet& set : sets) {
    const std::vector<PetscInt> all =
        gather_on_all(petsc::own_indices(set), MPIU_INT, PETSC_COMM_WORLD);
    EXPECT_EQ(all.size(), 60u);
    for (const PetscInt row : all) EXPECT_EQ(row % 2, all.front() % 2);
  }
}

TEST(EliminationOrder, OfSomeRowsIsThatOfTheirBlock)
{
  const petsc::Matrix A = joined_chains(400, 2);
  std::vector<PetscInt> kept = own_rows_of(A);
  std::erase(kept, 0);
  const petsc::IndexSet rows = set_of(kept);
  EXPECT_EQ(elimination_order(A, rows), elimination_order(own_submatrix(A, rows, rows)));
}

TEST(EliminationOrder, IsTheOneThatAMatrixWasGiven)
{
  const petsc::Matrix A = numbered();
  std::vector<int> backwards;
  if (petsc::rank(PETSC_COMM_WORLD) == 0)
    for (int place = matrix_order; place > 0; --place) backwards.push_back(place);
  keep_order(A, backwards);
  EXPECT_EQ(elimination_order(A), backwards);
}

}  // namespace
}  // namespace chladni::linear
