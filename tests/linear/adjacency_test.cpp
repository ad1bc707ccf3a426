#include "linear/kernels/matrix_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {
namespace {

using Lists = std::vector<std::vector<int>>;

/// Neighbours without order, a few of them in one direction only.
Lists random_lists(int n, double one_way)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Lists lists(n);
  for (int v = 0; v < n; ++v) {
    for (int w = 0; w < v; ++w) {
      if (uniform(generator) > 0.2) continue;
      const double side = uniform(generator);
      if (side > one_way) lists[v].insert(lists[v].begin(), w);
      if (side > one_way || side < 0.5 * one_way) lists[w].push_back(v);
      if (side <= one_way && side >= 0.5 * one_way) lists[v].push_back(w);
    }
  }
  return lists;
}

Adjacency graph_of(const Lists& lists, int first, int last)
{
  Adjacency graph;
  for (int v = first; v < last; ++v) {
    graph.neighbours.insert(graph.neighbours.end(), lists[v].begin(), lists[v].end());
    graph.starts.push_back(static_cast<int>(graph.neighbours.size()));
  }
  return graph;
}

/// Those that lack, ascending, behind the others.
Lists with_partners(const Lists& lists)
{
  Lists both = lists;
  for (int w = 0; w < std::ssize(lists); ++w)
    for (const int v : lists[w])
      if (std::ranges::find(lists[v], w) == lists[v].end()) both[v].push_back(w);
  return both;
}

TEST(JoinedAdjacency, IsThatOfAllRanksInBothDirections)
{
  const int n = 61, rank = petsc::rank(PETSC_COMM_WORLD), n_ranks = petsc::size(PETSC_COMM_WORLD);
  for (const double one_way : {0.0, 0.1, 1.0}) {
    const Lists lists = random_lists(n, one_way);
    const Adjacency expected = graph_of(with_partners(lists), 0, n);
    EXPECT_TRUE(is_symmetric(expected));
    EXPECT_EQ(one_way == 0.0, is_symmetric(graph_of(lists, 0, n)));
    const Adjacency whole =
        joined(graph_of(lists, n * rank / n_ranks, n * (rank + 1) / n_ranks), PETSC_COMM_WORLD);
    EXPECT_EQ(whole.starts, expected.starts);
    EXPECT_EQ(whole.neighbours, expected.neighbours);
    EXPECT_EQ(symmetrized(graph_of(lists, 0, n)).neighbours, expected.neighbours);
  }
}

}  // namespace
}  // namespace chladni::linear
