#include "linear/cholesky/elimination_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "common/petsc.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "matrices.hpp"

namespace chladni::linear {
namespace {

/// Of a square grid with side x side vertices and their eight neighbours.
Adjacency grid(int side)
{
  Adjacency graph;
  for (int v = 0; v < side * side; ++v) {
    const int x = v % side, y = v / side;
    for (int j = std::max(0, y - 1); j <= std::min(side - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(side - 1, x + 1); ++i)
        if (j * side + i != v) graph.neighbours.push_back(j * side + i);
    graph.starts.push_back(static_cast<int>(graph.neighbours.size()));
  }
  return graph;
}

petsc::Matrix laplacian(int side)
{
  const Adjacency graph = grid(side);
  constexpr int most_neighbours = 9;
  return testing::matrix(side * side, most_neighbours, [&](PetscInt v) {
    testing::Row row{{v, most_neighbours}};
    for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k)
      row.push_back({graph.neighbours[k], -1.0});
    return row;
  });
}

TEST(SharedDissection, NumbersEachVertexOnce)
{
  const Adjacency graph = grid(40);
  const std::vector<int> weights(1600, 1);
  std::vector<int> places = shared_dissection(graph, weights, PETSC_COMM_WORLD);
  if (petsc::rank(PETSC_COMM_WORLD) != 0) {
    EXPECT_TRUE(places.empty());
    return;
  }
  std::ranges::sort(places);
  for (int i = 0; i < std::ssize(places); ++i) ASSERT_EQ(places[i], i);
  EXPECT_EQ(places.size(), 1600);
}

TEST(SharedDissection, OfAGraphWithoutEdgesIsAnyOrder)
{
  Adjacency graph;
  graph.starts.assign(6, 0);
  const std::vector<int> places =
      shared_dissection(graph, std::vector<int>(5, 1), PETSC_COMM_WORLD);
  EXPECT_EQ(places.size(), petsc::rank(PETSC_COMM_WORLD) == 0 ? 5 : 0);
}

/// Large enough for the ranks to dissect it together.
TEST(SharedDissection, FillsTheFactorAsTheDissectionOfOneRankDoes)
{
  constexpr int side = 120;
  const petsc::Matrix A = laplacian(side);
  SupernodalFactor factor(PETSC_COMM_WORLD);
  factor.analyze(A);
  const petsc::Matrix same = [&] {
    petsc::Matrix own;
    const Adjacency graph = grid(side);
    petsc::check(MatCreateSeqAIJ(PETSC_COMM_SELF, side * side, side * side, 9, nullptr, own.put()));
    for (int v = 0; v < side * side; ++v) {
      petsc::check(MatSetValue(own, v, v, 9.0, INSERT_VALUES));
      for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k)
        petsc::check(MatSetValue(own, v, graph.neighbours[k], -1.0, INSERT_VALUES));
    }
    testing::finish(own);
    return own;
  }();
  SupernodalFactor alone(PETSC_COMM_SELF);
  alone.analyze(same);
  EXPECT_LT(factor.size().operations, 1.15 * alone.size().operations);
  EXPECT_LT(factor.size().entries, 1.1 * alone.size().entries);
}

/// The row of a copy of a vertex: two rows for each, those of two neighbouring vertices in turn.
int row_of(int vertex, int copy)
{
  return vertex / 2 * 4 + copy * 2 + vertex % 2;
}

/// Both copies of a vertex are coupled with both of each neighbour.
petsc::Matrix doubled(const Adjacency& graph)
{
  constexpr int most_entries = 18;
  return testing::matrix(2 * graph.n_vertices(), most_entries, [&](PetscInt row) {
    const PetscInt v = row / 4 * 2 + row % 2;
    testing::Row entries{{row, most_entries}, {row_of(v, row % 4 < 2 ? 1 : 0), -1.0}};
    for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k)
      for (int copy = 0; copy < 2; ++copy)
        entries.push_back({row_of(graph.neighbours[k], copy), -1.0});
    return entries;
  });
}

void expect_each_place_once(std::vector<int> places)
{
  std::ranges::sort(places);
  for (int i = 0; i < std::ssize(places); ++i) ASSERT_EQ(places[i], i + 1);
}

TEST(EliminationOrder, KeepsRowsWithTheSameColumnsTogether)
{
  const Adjacency graph = grid(72);
  const std::vector<int> places = elimination_order(doubled(graph));
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  ASSERT_EQ(places.size(), 2 * graph.n_vertices());
  expect_each_place_once(places);
  int n_apart = 0;
  for (int v = 0; v < graph.n_vertices(); ++v)
    n_apart += std::abs(places[row_of(v, 0)] - places[row_of(v, 1)]) != 1;
  EXPECT_LE(n_apart, 4 * petsc::size(PETSC_COMM_WORLD));  // where a rank's rows end
}

TEST(EliminationOrder, OfSomeRowsIsThatOfTheirMatrix)
{
  const petsc::Matrix A = doubled(grid(80));
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  std::vector<PetscInt> own;
  for (PetscInt row = begin; row < end; ++row)
    if (row % 13 != 5) own.push_back(row);
  petsc::IndexSet rows;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, rows.put()));
  const std::vector<int> places = elimination_order(A, rows);
  EXPECT_EQ(places, elimination_order(own_submatrix(A, rows, rows)));
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  EXPECT_GT(places.size(), 10000);  // or the ranks do not dissect it together
  expect_each_place_once(places);
}

}  // namespace
}  // namespace chladni::linear
