#include "linear/cholesky/elimination_order.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "matrices.hpp"

namespace chladni::linear {
namespace {

TEST(ExtendedOrder, PutsOtherRowsBehindTheLastOfTheirNeighbours)
{
  // A chain of eight whose rows 2 and 5 are not known, and a row without neighbours.
  const petsc::Matrix A = testing::matrix(9, 3, [](PetscInt i) {
    testing::Row row{{i, 2.0}};
    if (i > 0 && i < 8) row.emplace_back(i - 1, -1.0);
    if (i < 7) row.emplace_back(i + 1, -1.0);
    return row;
  });
  const std::vector<int> known{3, 0, -1, 4, 2, -1, 1, 5, -1};
  // In their order: 1, 6 and behind it none, 4 and behind it 5, 0, 3 and behind it 2, 7, then 8.
  EXPECT_EQ(extended_order(A, known), (std::vector<int>{4, 0, 6, 5, 2, 3, 1, 7, 8}));
}

}  // namespace
}  // namespace chladni::linear
