#include "linear/cholesky/supernodal/assembly_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "linear/cholesky/supernodal/elimination_tree.hpp"

namespace chladni::linear {

namespace {

/// Numbers of the triangle of `columns` and of the rows below it.
double trapezoid(double columns, double below)
{
  return columns * (columns + 1.0) / 2.0 + columns * below;
}

/// Supernodes that take up their children where that stores few zeros.
class Amalgamation {
 public:
  Amalgamation(const QuotientGraph& graph, FundamentalSupernodes supernodes)
      : all_(std::move(supernodes)),
        first_child_(all_.size(), none),
        sibling_(all_.size(), none),
        next_member_(all_.size(), none),
        first_member_(all_.size()),
        last_member_(all_.size()),
        columns_(all_.size(), 0.0),
        below_(all_.size(), 0.0),
        entries_(all_.size())
  {
    std::vector<int> n_rows;  // by places
    for (const int v : all_.order) n_rows.push_back(graph.n_rows[v]);
    for (int s = all_.size() - 1; s >= 0; --s) {
      first_member_[s] = last_member_[s] = s;
      for (int j = all_.first_column[s]; j < all_.first_column[s + 1]; ++j)
        columns_[s] += n_rows[j];
      for (const int i : all_.below_of(s)) below_[s] += n_rows[i];
      entries_[s] = trapezoid(columns_[s], below_[s]);
      if (const int parent = all_.parent[s]; parent != none)
        sibling_[s] = std::exchange(first_child_[parent], s);
    }
    for (int s = 0; s < all_.size(); ++s) take_up_children(s);
  }

  /// Calls visit(s) for what is left, children before parents.
  template <typename Visit>
  void in_postorder(const Visit& visit) const
  {
    std::vector<int> stack, next(first_child_);
    for (int root = 0; root < all_.size(); ++root) {
      if (all_.parent[root] != none) continue;
      stack.push_back(root);
      while (!stack.empty()) {
        const int s = stack.back();
        if (next[s] != none) {
          stack.push_back(next[s]);
          next[s] = sibling_[next[s]];
        } else {
          visit(s);
          stack.pop_back();
        }
      }
    }
  }

  /// Calls visit(v) for the vertices of the columns, in the order of their elimination.
  template <typename Visit>
  void for_columns(int s, const Visit& visit) const
  {
    for (int member = first_member_[s]; member != none; member = next_member_[member])
      for (int j = all_.first_column[member]; j < all_.first_column[member + 1]; ++j)
        visit(all_.order[j]);
  }
  template <typename Visit>
  void for_below(int s, const Visit& visit) const
  {
    for (const int i : all_.below_of(s)) visit(all_.order[i]);
  }
  /// -1 for a root.
  int parent(int s) const { return all_.parent[s]; }
  int size() const { return all_.size(); }
  double n_rows_below(int s) const { return below_[s]; }

 private:
  static constexpr int none = -1;

  /// Narrow supernodes waste more in calls and gathers than in zeros.
  bool pays(int child, int parent) const
  {
    const double columns = columns_[child] + columns_[parent];
    const double stored = trapezoid(columns, below_[parent]);
    const double zeros = (stored - entries_[child] - entries_[parent]) / stored;
    constexpr double narrow = 12.0, medium = 36.0, wide = 96.0;
    if (columns <= narrow) return zeros < 0.8;
    if (columns <= medium) return zeros < 0.3;
    if (columns <= wide) return zeros < 0.1;
    return zeros < 0.03;
  }

  void take_up_children(int s)
  {
    candidates_.clear();
    left_.clear();
    for (int child = first_child_[s]; child != none; child = sibling_[child])
      candidates_.push_back(child);
    std::ranges::sort(candidates_, [&](int a, int b) { return below_[a] > below_[b]; });
    for (const int child : candidates_) {
      if (!pays(child, s)) {
        left_.push_back(child);
        continue;
      }
      next_member_[last_member_[child]] = first_member_[s];  // its columns come first
      first_member_[s] = first_member_[child];
      columns_[s] += columns_[child];
      entries_[s] += entries_[child];
      for (int k = first_child_[child]; k != none; k = sibling_[k]) left_.push_back(k);
    }
    int* link = &first_child_[s];
    for (const int child : left_) {
      all_.parent[child] = s;
      *link = child;
      link = &sibling_[child];
    }
    *link = none;
  }

  FundamentalSupernodes all_;
  std::vector<int> first_child_, sibling_;
  std::vector<int> next_member_, first_member_, last_member_;  ///< those that one has taken up
  std::vector<double> columns_, below_;                        ///< rows of the matrix
  std::vector<double> entries_;                                ///< without the stored zeros
  std::vector<int> candidates_, left_;
};

/// The vertices in the order of their first rows' places.
std::vector<int> order_of_vertices(const QuotientGraph& graph, const std::vector<int>& places)
{
  std::vector<int> row_at(places.size() + 2, -1), order;
  for (std::size_t row = 0; row < places.size(); ++row) row_at[places[row]] = static_cast<int>(row);
  std::vector<char> is_taken(graph.n_vertices(), 0);
  for (const int row : row_at)
    if (row != -1 && std::exchange(is_taken[graph.vertex_of_row[row]], 1) == 0)
      order.push_back(graph.vertex_of_row[row]);
  if (std::ssize(order) != graph.n_vertices())
    throw Error("assembly_tree: two rows have the same place in the elimination");
  return order;
}

/// The rows of each vertex.
struct RowsOfVertices {
  std::vector<int> starts, rows;

  explicit RowsOfVertices(const QuotientGraph& graph)
      : starts(graph.n_vertices() + 1, 0), rows(graph.vertex_of_row.size())
  {
    std::inclusive_scan(graph.n_rows.begin(), graph.n_rows.end(), starts.begin() + 1);
    std::vector<int> next(starts.begin(), starts.end() - 1);
    for (std::size_t row = 0; row < rows.size(); ++row)
      rows[next[graph.vertex_of_row[row]]++] = static_cast<int>(row);
  }
};

}  // namespace

double AssemblyTree::n_entries(int s) const
{
  return trapezoid(n_columns(s), n_below[s]);
}

double AssemblyTree::n_operations(int s) const
{
  const double w = n_columns(s);
  const double m = n_below[s];
  return w * w * w / 3.0 + w * w * m + w * m * m;
}

AssemblyTree assembly_tree(const QuotientGraph& graph, const std::vector<int>& places,
                           const WhatMatters& matters)
{
  const Amalgamation supernodes(graph,
                                fundamental_supernodes(graph, order_of_vertices(graph, places)));
  const RowsOfVertices rows(graph);
  AssemblyTree tree{.position = std::vector<int>(places.size()),
                    .row = {},
                    .first_column = {0},
                    .parent = {},
                    .n_below = {},
                    .below_starts = {0},
                    .below_rows = {}};
  tree.row.reserve(places.size());
  std::vector<int> number(supernodes.size(), -1), first_position(graph.n_vertices());
  std::vector<int> left;  // in postorder
  supernodes.in_postorder([&](int s) {
    number[s] = static_cast<int>(left.size());
    left.push_back(s);
    supernodes.for_columns(s, [&](int v) {
      first_position[v] = static_cast<int>(tree.row.size());
      for (int k = rows.starts[v]; k < rows.starts[v + 1]; ++k) {
        tree.position[rows.rows[k]] = static_cast<int>(tree.row.size());
        tree.row.push_back(rows.rows[k]);
      }
    });
    tree.first_column.push_back(static_cast<int>(tree.row.size()));
  });
  for (const int s : left) {
    const int parent = supernodes.parent(s);
    tree.parent.push_back(parent == -1 ? -1 : number[parent]);
    tree.n_below.push_back(static_cast<int>(supernodes.n_rows_below(s)));
  }
  const std::vector<char> does_matter =
      matters ? matters(tree) : std::vector<char>(tree.n_below.size(), 1);
  std::size_t n_all = 0;
  for (std::size_t i = 0; i < does_matter.size(); ++i)
    if (does_matter[i] != 0) n_all += std::size_t(tree.n_below[i]);
  tree.below_rows.reserve(n_all);
  std::vector<int> firsts;  // of the vertices below one of them
  for (const int s : left) {
    if (does_matter[number[s]] != 0) {
      firsts.clear();
      supernodes.for_below(s, [&](int v) { firsts.push_back(first_position[v]); });
      if (!std::ranges::is_sorted(firsts)) std::ranges::sort(firsts);
      for (const int first : firsts) {
        const int n = graph.n_rows[graph.vertex_of_row[tree.row[first]]];
        for (int k = 0; k < n; ++k) tree.below_rows.push_back(first + k);
      }
    }
    tree.below_starts.push_back(tree.below_rows.size());
  }
  return tree;
}

}  // namespace chladni::linear
