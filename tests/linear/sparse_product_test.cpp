#include "linear/kernels/sparse_product.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/random_block.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

constexpr PetscInt dofs = 6;

/// Whether two DOFs of a flat shell are coupled: those of bending, and those in the plane.
bool are_coupled(PetscInt a, PetscInt b)
{
  const auto bends = [](PetscInt dof) { return dof >= 2 && dof <= 4; };
  return bends(a) == bends(b);
}

/// A chain of nodes of a flat shell, with another number at each place.
petsc::Matrix flat_shell(PetscInt n_nodes)
{
  return testing::matrix(dofs * n_nodes, 9, [&](PetscInt i) {
    testing::Row row;
    for (PetscInt j = std::max(0, i / dofs - 1) * dofs; j < std::min(n_nodes, i / dofs + 2) * dofs;
         ++j)
      if (are_coupled(i % dofs, j % dofs)) row.emplace_back(j, 1.0 / (1.0 + i + j));
    return row;
  });
}

/// One column, and more than a narrow and a wide panel have.
class ProductWithNodes : public ::testing::TestWithParam<PetscInt> {};

TEST_P(ProductWithNodes, EqualsPetscs)
{
  const petsc::Matrix A = flat_shell(40);
  petsc::Matrix X = uninitialized_dense(A, GetParam()), AX = uninitialized_dense(A, GetParam());
  petsc::Matrix by_PETSc;
  fill_with_random_numbers(X, 0);
  SparseProduct(A).apply(X, AX);
  petsc::check(MatMatMult(A, X, MAT_INITIAL_MATRIX, petsc::automatic, by_PETSc.put()));
  double norm = 0.0, error = 0.0;
  petsc::check(MatNorm(by_PETSc, NORM_FROBENIUS, &norm));
  petsc::check(MatAXPY(AX, -1.0, by_PETSc, SAME_NONZERO_PATTERN));
  petsc::check(MatNorm(AX, NORM_FROBENIUS, &error));
  EXPECT_LT(error, 1e-15 * norm);  // nine terms each
}

TEST(SparseProduct, OfSomeRowsIsZeroInTheOthers)
{
  constexpr PetscInt n_columns = 11;
  const petsc::Matrix A = flat_shell(40);
  petsc::Matrix X = uninitialized_dense(A, n_columns), all = uninitialized_dense(A, n_columns),
                some = uninitialized_dense(A, n_columns);
  fill_with_random_numbers(X, 0);
  SparseProduct(A).apply(X, all);
  std::vector<PetscInt> rows;  // of bending
  const PetscInt n = LocalRows(X).n_rows();
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  for (PetscInt i = 0; i < n; ++i)
    if (are_coupled((first + i) % dofs, 2)) rows.push_back(i);
  SparseProduct(A, rows).apply(X, some);
  const LocalRows expected(all), found(some);
  for (PetscInt j = 0; j < n_columns; ++j)
    for (PetscInt i = 0; i < n; ++i)
      EXPECT_EQ(found(i, j), std::ranges::binary_search(rows, i) ? expected(i, j) : 0.0);
}

INSTANTIATE_TEST_SUITE_P(Widths, ProductWithNodes, ::testing::Values(1, 9, 17, 27));

}  // namespace
}  // namespace chladni::linear
