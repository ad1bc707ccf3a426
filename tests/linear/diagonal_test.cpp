#include "linear/kernels/sparse_matrices.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "matrices.hpp"

namespace chladni::linear {
namespace {

/// Of each row here, by PETSc.
void expect_as_by_petsc(Mat A)
{
  petsc::Vector expected;
  petsc::check(MatCreateVecs(A, nullptr, expected.put()));
  petsc::check(MatGetDiagonal(A, expected));
  PetscBool is_same = PETSC_FALSE;
  petsc::check(VecEqual(diagonal(A), expected, &is_same));
  EXPECT_EQ(is_same, PETSC_TRUE);
}

/// A row has its neighbours on both sides, and itself where it is said to.
petsc::Matrix chain(const std::function<bool(PetscInt)>& has_itself)
{
  constexpr PetscInt n = 30;
  return testing::matrix(n, 3, [&](PetscInt i) {
    testing::Row row;
    if (i > 0) row.emplace_back(i - 1, -1.0);
    if (has_itself(i)) row.emplace_back(i, 2.0 + i);
    if (i + 1 < n) row.emplace_back(i + 1, -1.0);
    return row;
  });
}

TEST(Diagonal, IsThatOfEveryRow)
{
  const petsc::Matrix A = chain([](PetscInt) { return true; });
  expect_as_by_petsc(A);
  PetscInt row = 0;
  PetscReal largest = 0.0;
  petsc::check(VecMax(diagonal(A), &row, &largest));
  EXPECT_EQ(row, 29);
  EXPECT_EQ(largest, 31.0);
}

TEST(Diagonal, IsZeroWhereARowHasNone)
{
  const petsc::Matrix A = chain([](PetscInt i) { return i != 7; });
  expect_as_by_petsc(A);
  PetscReal least = 1.0;
  petsc::check(VecMin(diagonal(A), nullptr, &least));
  EXPECT_EQ(least, 0.0);
}

TEST(Diagonal, OfAnotherTypeIsReadByPetsc)
{
  const petsc::Matrix A = chain([](PetscInt) { return true; });
  petsc::Matrix dense;
  petsc::check(MatConvert(A, MATDENSE, MAT_INITIAL_MATRIX, dense.put()));
  expect_as_by_petsc(dense);
}

}  // namespace
}  // namespace chladni::linear
