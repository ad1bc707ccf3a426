#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/checked_count.hpp"
#include "linear/cholesky/supernodal/assembly_tree.hpp"
#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/rank_groups.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/kernels/storage.hpp"
#include "tests/linear/random_matrix.hpp"

namespace chladni::linear {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Grid of side x side nodes, each joined to its eight neighbours, with so many rows each.
struct Grid {
  QuotientGraph graph;
  std::vector<int> places;  ///< of the rows: nested dissection by halves
};

void dissect(int x0, int x1, int y0, int y1, int side, std::vector<int>& order)
{
  if (x1 - x0 < 3 && y1 - y0 < 3) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) order.push_back(y * side + x);
    return;
  }
  if (x1 - x0 >= y1 - y0) {
    const int middle = (x0 + x1) / 2;
    dissect(x0, middle, y0, y1, side, order);
    dissect(middle + 1, x1, y0, y1, side, order);
    for (int y = y0; y < y1; ++y) order.push_back(y * side + middle);
  } else {
    const int middle = (y0 + y1) / 2;
    dissect(x0, x1, y0, middle, side, order);
    dissect(x0, x1, middle + 1, y1, side, order);
    for (int x = x0; x < x1; ++x) order.push_back(middle * side + x);
  }
}

Grid grid(int side, int rows_per_node)
{
  Grid made{.graph = {.vertex_of_row = {},
                      .n_rows = std::vector<int>(side * side, rows_per_node),
                      .edges = {}},
            .places = std::vector<int>(side * side * rows_per_node)};
  for (int node = 0; node < side * side; ++node) {
    const int x = node % side, y = node / side;
    for (int r = 0; r < rows_per_node; ++r) made.graph.vertex_of_row.push_back(node);
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, side - 1); ++j) {
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, side - 1); ++i)
        if (j * side + i != node) made.graph.edges.neighbours.push_back(j * side + i);
    }
    made.graph.edges.starts.push_back(static_cast<int>(made.graph.edges.neighbours.size()));
  }
  std::vector<int> order;
  dissect(0, side, 0, side, side, order);
  for (int k = 0; k < std::ssize(order); ++k)
    for (int r = 0; r < rows_per_node; ++r)
      made.places[order[k] * rows_per_node + r] = k * rows_per_node + r + 1;
  return made;
}

/// Where the Cholesky factor of the permuted matrix is not zero, by elimination of every column.
Eigen::MatrixXi filled_pattern(const QuotientGraph& graph, const std::vector<int>& position)
{
  const auto n = static_cast<int>(position.size());
  Eigen::MatrixXi pattern = Eigen::MatrixXi::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = graph.vertex_of_row[i], b = graph.vertex_of_row[j];
      const auto begin = graph.edges.neighbours.begin();
      const bool touch =
          a == b || std::find(begin + graph.edges.starts[a], begin + graph.edges.starts[a + 1],
                              b) != begin + graph.edges.starts[a + 1];
      if (touch) pattern(position[i], position[j]) = 1;
    }
  }
  for (int k = 0; k < n; ++k) {
    for (int i = k + 1; i < n; ++i) {
      if (pattern(i, k) == 0) continue;
      for (int j = k + 1; j < n; ++j) pattern(i, j) |= pattern(j, k);
    }
  }
  return pattern;
}

TEST(CheckedCount, RefusesWhatThirtyTwoBitsDoNotHold)
{
  EXPECT_EQ(checked_count(largest_count, "entries", ""), largest_count);
  try {
    checked_count(largest_count + 1, "entries of K", "use more ranks");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "2147483648 entries of K are more than the 2147483647 that indices of 32 bits "
                 "count; use more ranks");
  }
}

TEST(Offsets, RefuseMoreThanACallOfMpiCounts)
{
  EXPECT_EQ(offsets({3, 0, 2}), (std::vector<int>{0, 3, 3, 5}));
  EXPECT_THROW(offsets({2'000'000'000, 2'000'000'000}), Error);
}

TEST(Adjacency, HasEachEdgeInBothDirections)
{
  const Adjacency one_way{.starts = {0, 2, 3, 3, 4}, .neighbours = {3, 1, 2, 0}};
  EXPECT_FALSE(is_symmetric(one_way));
  const Adjacency both = symmetrized(one_way);
  EXPECT_TRUE(is_symmetric(both));
  EXPECT_EQ(both.starts, (std::vector<int>{0, 2, 4, 5, 6}));
  EXPECT_EQ(both.neighbours, (std::vector<int>{3, 1, 2, 0, 1, 0}));
  EXPECT_EQ(symmetrized(both).neighbours, both.neighbours);  // in the same order
}

TEST(AssemblyTree, HoldsEveryEntryOfTheFactor)
{
  for (const int rows_per_node : {1, 3}) {
    const Grid plate = grid(9, rows_per_node);
    const AssemblyTree tree = assembly_tree(plate.graph, plate.places);
    const auto n = static_cast<int>(plate.places.size());
    std::vector<int> sorted = tree.position, all(n);
    std::ranges::sort(sorted);
    std::iota(all.begin(), all.end(), 0);
    ASSERT_EQ(sorted, all);
    for (int p = 0; p < n; ++p) EXPECT_EQ(tree.position[tree.row[p]], p);
    Eigen::MatrixXi stored = Eigen::MatrixXi::Zero(n, n);
    double n_entries = 0.0;
    for (int s = 0; s < tree.n_supernodes(); ++s) {
      EXPECT_TRUE(tree.parent[s] == -1 || tree.parent[s] > s);
      EXPECT_TRUE(std::ranges::is_sorted(tree.below(s)));
      for (int p = tree.first_column[s]; p < tree.first_column[s + 1]; ++p) {
        stored.col(p).segment(p, tree.first_column[s + 1] - p).setOnes();
        for (const int row : tree.below(s)) stored(row, p) = 1;
      }
      n_entries += tree.n_entries(s);
    }
    EXPECT_EQ(stored.sum(), int(n_entries));
    const Eigen::MatrixXi needed = filled_pattern(plate.graph, tree.position);
    int n_needed = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = j; i < n; ++i) {
        n_needed += needed(i, j);
        EXPECT_LE(needed(i, j), stored(i, j)) << i << ' ' << j;
      }
    }
    EXPECT_LT(n_entries, 1.6 * n_needed);  // few zeros are stored, in small supernodes most
  }
}

TEST(AssemblyTree, PassesOnWhatAChildLeavesToItsParent)
{
  const Grid plate = grid(12, 2);
  const AssemblyTree tree = assembly_tree(plate.graph, plate.places);
  for (int s = 0; s < tree.n_supernodes(); ++s) {
    if (tree.parent[s] == -1) {
      EXPECT_TRUE(tree.below(s).empty());
      continue;
    }
    const int parent = tree.parent[s];
    for (const int row : tree.below(s)) {
      const bool is_column =
          row >= tree.first_column[parent] && row < tree.first_column[parent + 1];
      EXPECT_TRUE(is_column || std::ranges::binary_search(tree.below(parent), row));
    }
  }
}

/// Entries of the factor on each rank.
std::vector<double> entries_of_ranks(const AssemblyTree& tree, const std::vector<RankGroup>& group,
                                     int n_ranks)
{
  std::vector<double> entries(n_ranks, 0.0);
  for (int s = 0; s < tree.n_supernodes(); ++s)
    for (int rank = group[s].first; rank < group[s].last; ++rank)
      entries[rank] += entries_of_rank(tree, s, group[s], rank - group[s].first);
  return entries;
}

TEST(RankGroups, AreHalvesOfHalves)
{
  EXPECT_TRUE(groups_of(0, 1).empty());
  EXPECT_EQ(groups_of(1, 2), (std::vector<RankGroup>{{0, 2}}));
  EXPECT_EQ(groups_of(2, 3), (std::vector<RankGroup>{{0, 3}}));
  EXPECT_EQ(groups_of(0, 3), (std::vector<RankGroup>{{0, 2}, {0, 3}}));
  EXPECT_EQ(groups_of(5, 8), (std::vector<RankGroup>{{4, 6}, {4, 8}, {0, 8}}));
}

TEST(ShareSubtrees, SharesAFrontAmongTheRanksBelowItAlone)
{
  const Grid plate = grid(60, 3);
  const AssemblyTree tree = assembly_tree(plate.graph, plate.places);
  for (const int n_ranks : {1, 2, 3, 5, 8, 13}) {
    const std::vector<RankGroup> group = share_subtrees(tree, n_ranks);
    for (int s = 0; s < tree.n_supernodes(); ++s) {
      const auto groups = groups_of(group[s].first, n_ranks);
      EXPECT_TRUE(group[s].size() == 1 || std::ranges::find(groups, group[s]) != groups.end());
      if (tree.parent[s] == -1) continue;
      const RankGroup& above = group[tree.parent[s]];
      EXPECT_LE(above.first, group[s].first);
      EXPECT_GE(above.last, group[s].last);
    }
  }
}

TEST(ShareSubtrees, GivesEachRankLessTheMoreTheyAre)
{
  const Grid plate = grid(60, 3);
  const AssemblyTree tree = assembly_tree(plate.graph, plate.places);
  double whole = 0.0, before = INFINITY;
  for (int s = 0; s < tree.n_supernodes(); ++s) whole += tree.n_entries(s);
  for (const auto& [n_ranks, least] :
       {std::pair{1, 1.0}, {2, 1.98}, {3, 2.9}, {4, 3.9}, {8, 7.7}, {16, 15.0}, {64, 50.0}}) {
    const double largest =
        std::ranges::max(entries_of_ranks(tree, share_subtrees(tree, n_ranks), n_ranks));
    EXPECT_LE(largest, before) << n_ranks << " ranks";
    EXPECT_GE(whole / largest, least) << n_ranks << " ranks";
    before = largest;
  }
}

TEST(AssemblyTree, HasTheRowsBelowWhatARankSeesAlone)
{
  const Grid plate = grid(40, 3);
  const AssemblyTree whole = assembly_tree(plate.graph, plate.places);
  constexpr int n_ranks = 5;
  std::size_t n_rows = 0;
  int n_foreign = 0;  // of which a rank takes up what others leave over
  for (int rank = 0; rank < n_ranks; ++rank) {
    std::vector<RankGroup> group;
    const AssemblyTree tree =
        assembly_tree(plate.graph, plate.places, [&](const AssemblyTree& known) {
          group = share_subtrees(known, n_ranks);
          return seen_by(rank, known, group);
        });
    EXPECT_EQ(group, share_subtrees(whole, n_ranks));
    ASSERT_EQ(tree.parent, whole.parent);
    EXPECT_EQ(tree.n_below, whole.n_below);
    for (int s = 0; s < tree.n_supernodes(); ++s) {
      const int parent = tree.parent[s];
      const bool takes_up = parent != -1 && group[parent].has(rank);
      if (group[s].has(rank) || takes_up) {
        EXPECT_TRUE(std::ranges::equal(tree.below(s), whole.below(s))) << s;
        n_foreign += group[s].has(rank) ? 0 : 1;
      } else {
        EXPECT_TRUE(tree.below(s).empty()) << s;
      }
    }
    n_rows += tree.below_rows.size();
    EXPECT_LT(tree.below_rows.size(), whole.below_rows.size());
  }
  EXPECT_GT(n_foreign, 0);
  EXPECT_LT(double(n_rows), 1.8 * double(whole.below_rows.size()));
}

/// Two of one grid that are not coupled.
QuotientGraph twice(const QuotientGraph& one)
{
  const int n = one.n_vertices();
  QuotientGraph both = one;
  for (const int v : one.vertex_of_row) both.vertex_of_row.push_back(v + n);
  both.n_rows.insert(both.n_rows.end(), one.n_rows.begin(), one.n_rows.end());
  for (const int v : one.edges.neighbours) both.edges.neighbours.push_back(v + n);
  for (int v = 0; v < n; ++v)
    both.edges.starts.push_back(one.edges.starts.back() + one.edges.starts[v + 1]);
  return both;
}

TEST(ShareSubtrees, GivesEachRankItsShareOfEachOfTwoTrees)
{
  const Grid one = grid(40, 3);
  std::vector<int> places = one.places;
  for (const int place : one.places) places.push_back(place + static_cast<int>(one.places.size()));
  const AssemblyTree tree = assembly_tree(twice(one.graph), places);
  const int n = tree.n_supernodes();
  const auto n_rows = static_cast<int>(one.places.size());
  for (const int n_ranks : {2, 4}) {
    const std::vector<RankGroup> group = share_subtrees(tree, n_ranks);
    std::vector<std::vector<double>> entries(2, std::vector<double>(n_ranks, 0.0));
    for (int s = 0; s < n; ++s) {
      if (group[s].size() > 1) continue;
      const int which = tree.row[tree.first_column[s]] < n_rows ? 0 : 1;
      entries[which][group[s].first] += tree.n_entries(s);
    }
    for (const std::vector<double>& of_tree : entries)
      EXPECT_GT(std::ranges::min(of_tree), 0.5 * std::ranges::max(of_tree)) << n_ranks << " ranks";
  }
}

/// Sizes: columns that are eliminated, rows below.
class Front : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  int w = GetParam().first, m = GetParam().second, n = w + m;
};

INSTANTIATE_TEST_SUITE_P(Sizes, Front,
                         ::testing::Values(std::pair{1, 0}, std::pair{1, 1}, std::pair{5, 3},
                                           std::pair{6, 6}, std::pair{7, 13}, std::pair{24, 70},
                                           std::pair{25, 1}, std::pair{90, 140}));

TEST_P(Front, IsEliminatedAsTheDenseMatrixIs)
{
  const MatrixXd R = random_matrix(n, n);
  const MatrixXd A = R * R.transpose() + n * MatrixXd::Identity(n, n);
  MatrixXd columns = A.leftCols(w), scaled = MatrixXd::Zero(n, w);
  MatrixXd rest = 0.5 * A.bottomRightCorner(m, m);
  const FrontColumns front{columns.data(), scaled.data(), n, w};
  ASSERT_EQ(eliminate_columns(front), 0);
  subtract_from_rest(front, 2.0, rest.data());
  MatrixXd L = columns;
  L.topRows(w) = columns.topRows(w).triangularView<Eigen::UnitLower>();
  const VectorXd d = columns.diagonal();
  const double round_off = 1e-14 * A.norm();
  const MatrixXd whole = L * d.asDiagonal() * L.transpose();
  EXPECT_LT((whole - A).leftCols(w).norm(), round_off);
  const MatrixXd left = A.bottomRightCorner(m, m) - whole.bottomRightCorner(m, m);
  for (int j = 0; j < m; ++j)
    for (int i = j; i < m; ++i) EXPECT_NEAR(rest(i, j), left(i, j), round_off);
}

TEST_P(Front, CountsNegativePivotsAndStopsAtNone)
{
  MatrixXd A = random_matrix(n, w);
  A.topRows(w).diagonal().array() += n;
  A(w - 1, w - 1) = -10.0 * n;
  MatrixXd scaled(n, w);
  EXPECT_EQ(eliminate_columns({A.data(), scaled.data(), n, w}), 1);
  for (const double bad : {0.0, std::nan("")}) {
    MatrixXd B = MatrixXd::Zero(n, w);
    B.diagonal().setOnes();
    B(w - 1, w - 1) = bad;
    EXPECT_EQ(eliminate_columns({B.data(), scaled.data(), n, w}), -1);
  }
}

/// The columns of L as tiles, with their first row at 3 of the panels and the others scattered.
TEST_P(Front, SolvesWithItsTiles)
{
  MatrixXd L = random_matrix(n, w);
  L.topRows(w).diagonal().array() += 3.0;
  const VectorXd d = L.topRows(w).diagonal();
  std::vector<int> below;
  for (int i = 0; i < m; ++i) below.push_back(3 + w + 2 * (m - 1 - i));
  const AlignedNumbers tiles = aligned_numbers(tiled_size(w, m));
  store_tiles(L.data(), w, m, tiles.get());
  const TiledColumns tiled{tiles.get(), w, 3, below};
  const int n_rows = 3 + w + 2 * m, n_panels = 3;
  const AlignedNumbers values = aligned_numbers(std::size_t(n_rows) * panel_width * n_panels);
  const Panels panels{values.get(), std::size_t(n_rows) * panel_width, n_panels};
  const auto entry = [&](int row, int column) -> double& {
    return values
        .get()[(column / panel_width) * panels.stride + row * panel_width + column % panel_width];
  };
  const MatrixXd B = random_matrix(n_rows, n_panels * panel_width);
  const auto fill = [&] {
    for (int j = 0; j < B.cols(); ++j)
      for (int i = 0; i < n_rows; ++i) entry(i, j) = B(i, j);
  };
  const MatrixXd unit = MatrixXd(L.topRows(w).triangularView<Eigen::UnitLower>());
  MatrixXd forward = B, backward = B;
  forward.middleRows(3, w) = unit.triangularView<Eigen::UnitLower>().solve(B.middleRows(3, w));
  MatrixXd pulled = d.cwiseInverse().asDiagonal() * B.middleRows(3, w);
  for (int i = 0; i < m; ++i) {
    forward.row(below[i]) -= L.row(w + i) * forward.middleRows(3, w);
    pulled -= L.row(w + i).transpose() * B.row(below[i]);
  }
  backward.middleRows(3, w) = unit.transpose().triangularView<Eigen::UnitUpper>().solve(pulled);
  const auto compare = [&](const MatrixXd& expected) {
    const double round_off = 1e-14 * expected.norm();
    for (int j = 0; j < B.cols(); ++j)
      for (int i = 0; i < n_rows; ++i) EXPECT_NEAR(entry(i, j), expected(i, j), round_off);
  };
  fill();
  solve_forward(tiled, panels);
  compare(forward);
  fill();
  solve_backward(tiled, panels);
  compare(backward);
}

TEST(TileKernels, OfThisProcessorDoWhatThePortableOnesDo)
{
  const TileKernels& here = tile_kernels();
  const TileKernels& portable = portable_tile_kernels();
  for (const int n_columns : {0, 1, 7, 40}) {
    const MatrixXd tile = random_matrix(tile_rows, n_columns);
    const MatrixXd X = random_matrix(panel_width, n_columns);
    const MatrixXd Y = random_matrix(panel_width, tile_rows);
    MatrixXd Y_here = Y, Y_portable = Y, X_here = X, X_portable = X;
    here.subtract(tile.data(), n_columns, X.data(), Y_here.data());
    portable.subtract(tile.data(), n_columns, X.data(), Y_portable.data());
    EXPECT_LT((Y_here - Y_portable).norm(), 1e-14 * n_columns + 1e-300);
    EXPECT_LT((Y_portable - (Y - X * tile.transpose())).norm(), 1e-14 * n_columns + 1e-300);
    here.subtract_transposed(tile.data(), n_columns, Y.data(), X_here.data());
    portable.subtract_transposed(tile.data(), n_columns, Y.data(), X_portable.data());
    EXPECT_LT((X_here - X_portable).norm(), 1e-14 * n_columns + 1e-300);
  }
  const MatrixXd L = random_matrix(tile_rows, tile_rows);  // by rows: its transpose
  const MatrixXd Y = random_matrix(panel_width, tile_rows);
  for (const auto solve : {&TileKernels::solve, &TileKernels::solve_transposed}) {
    MatrixXd Y_here = Y, Y_portable = Y;
    (here.*solve)(L.data(), Y_here.data());
    (portable.*solve)(L.data(), Y_portable.data());
    EXPECT_LT((Y_here - Y_portable).norm(), 1e-13);
  }
}

/// Columns of the basis, of the block.
class TallProducts : public ::testing::TestWithParam<std::pair<int, int>> {};

INSTANTIATE_TEST_SUITE_P(Sizes, TallProducts,
                         ::testing::Values(std::pair{0, 8}, std::pair{5, 1}, std::pair{12, 8},
                                           std::pair{25, 9}, std::pair{31, 24}));

TEST_P(TallProducts, AreThoseOfDenseAlgebra)
{
  const auto [n_basis, n_block] = GetParam();
  const int n_rows = 600;  // two chunks and a piece
  const MatrixXd V = random_matrix(n_rows, n_basis), Y = random_matrix(n_rows, n_block);
  const LongColumns basis{V.data(), n_rows, n_rows, n_basis};
  const Eigen::MatrixXd h = tall_inner_product(basis, {Y.data(), n_rows, n_rows, n_block});
  const MatrixXd expected = V.transpose() * Y;
  for (int j = 0; j < n_block; ++j)
    for (int i = 0; i < n_basis; ++i) EXPECT_NEAR(h(i, j), expected(i, j), 1e-12);
  MatrixXd left = Y;
  subtract_tall_product(basis, h, left.data(), n_rows);
  EXPECT_LT((left - (Y - V * expected)).norm(), 1e-11);
  MatrixXd product = MatrixXd::Constant(n_rows, n_block, std::nan(""));  // is not read
  tall_product(basis, h, product.data(), n_rows);
  EXPECT_LT((product - V * expected).norm(), 1e-11);
}

TEST(TallInnerProduct, OfManyRowsIsTheSumOfItsPieces)
{
  const int n_rows = 20'000, n_X = 7, n_Y = 8;  // more rows than are summed up one after the other
  const MatrixXd X = random_matrix(n_rows, n_X), Y = random_matrix(n_rows, n_Y);
  const Eigen::MatrixXd product =
      tall_inner_product({X.data(), n_rows, n_rows, n_X}, {Y.data(), n_rows, n_rows, n_Y});
  EXPECT_LT((product - X.transpose() * Y).norm(), 1e-15 * X.norm() * Y.norm());
}

}  // namespace
}  // namespace chladni::linear
