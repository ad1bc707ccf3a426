#include "linear/cholesky/shared_dissection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "common/petsc.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"
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

/// Two rows for each vertex, those of two neighbouring vertices in turn.
TEST(EliminationOrder, KeepsRowsWithTheSameColumnsTogether)
{
  constexpr int side = 72, most_entries = 18;
  const Adjacency graph = grid(side);
  const auto row_of = [](int vertex, int copy) { return vertex / 2 * 4 + copy * 2 + vertex % 2; };
  const petsc::Matrix A = testing::matrix(2 * graph.n_vertices(), most_entries, [&](PetscInt row) {
    const PetscInt v = row / 4 * 2 + row % 2;
    testing::Row entries{{row, most_entries}, {row_of(v, row % 4 < 2 ? 1 : 0), -1.0}};
    for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k)
      for (int copy = 0; copy < 2; ++copy)
        entries.push_back({row_of(graph.neighbours[k], copy), -1.0});
    return entries;
  });
  const std::vector<int> places = elimination_order(A);
  if (petsc::rank(PETSC_COMM_WORLD) != 0) return;
  ASSERT_EQ(places.size(), 2 * graph.n_vertices());
  std::vector<int> sorted = places;
  std::ranges::sort(sorted);
  for (int i = 0; i < std::ssize(sorted); ++i) ASSERT_EQ(sorted[i], i + 1);
  int n_apart = 0;
  for (int v = 0; v < graph.n_vertices(); ++v)
    n_apart += std::abs(places[row_of(v, 0)] - places[row_of(v, 1)]) != 1;
  EXPECT_LE(n_apart, 4 * petsc::size(PETSC_COMM_WORLD));  // where a rank's rows end
}

}  // namespace
}  // namespace chladni::linear
