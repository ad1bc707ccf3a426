#include "linear/cholesky/supernodal/assembly_tree.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "linear/cholesky/supernodal/quotient_graph.hpp"

namespace chladni::linear {

namespace {

/// The vertices of a quotient graph in supernodes without stored zeros: vertices that are
/// eliminated one after the other with the same structure. Children come before parents.
struct FundamentalSupernodes {
  std::vector<int> order;         ///< [n_vertices] in the order of their elimination, a postorder
  std::vector<int> first_column;  ///< [n + 1] place of the first vertex of each
  std::vector<int> parent;        ///< [n]; -1 for a root
  std::vector<std::size_t> below_first, below_last;  ///< [n] of its places in `below`
  std::vector<int> below;  ///< places of the vertices below each, ascending, with gaps between

  int size() const { return static_cast<int>(parent.size()); }
  std::span<const int> below_of(int s) const
  {
    return std::span(below).subspan(below_first[s], below_last[s] - below_first[s]);
  }
};

/// @param order  the vertices in the order of their elimination; kept up to a postorder
FundamentalSupernodes fundamental_supernodes(const QuotientGraph& graph,
                                             const std::vector<int>& order);

std::vector<int> inverse(const std::vector<int>& permutation)
{
  std::vector<int> result(permutation.size());
  for (std::size_t i = 0; i < permutation.size(); ++i) result[permutation[i]] = static_cast<int>(i);
  return result;
}

/// Of each vertex, by places; -1 at roots. Source: Liu, ACM TOMS 12 (1986) 127.
std::vector<int> elimination_tree(const QuotientGraph& graph, const std::vector<int>& order)
{
  const std::vector<int> place = inverse(order);
  std::vector<int> parent(order.size(), -1), ancestor(order.size(), -1);
  for (int j = 0; j < std::ssize(order); ++j) {
    for (int k = graph.edges.starts[order[j]]; k < graph.edges.starts[order[j] + 1]; ++k) {
      int i = place[graph.edges.neighbours[k]];
      while (i < j && i != -1) {
        const int next = std::exchange(ancestor[i], j);
        if (next == -1) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// Places such that each subtree stands together before its root.
std::vector<int> postorder(const std::vector<int>& parent)
{
  const auto n = static_cast<int>(parent.size());
  std::vector<int> first_child(n, -1), sibling(n, -1), order, stack;
  for (int i = n - 1; i >= 0; --i) {
    if (parent[i] == -1) continue;
    sibling[i] = first_child[parent[i]];
    first_child[parent[i]] = i;
  }
  for (int root = 0; root < n; ++root) {
    if (parent[root] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      if (first_child[top] != -1) {
        stack.push_back(first_child[top]);
        first_child[top] = sibling[first_child[top]];
      } else {
        order.push_back(top);
        stack.pop_back();
      }
    }
  }
  return order;
}

/// Symbolic factorisation, supernode by supernode in postorder.
class Structures {
 public:
  Structures(const QuotientGraph& graph, std::vector<int> order)
      : graph_(graph),
        place_(inverse(order)),
        seen_by_(order.size(), none),
        first_child_(order.size(), none)
  {
    found_.order = std::move(order);
    found_.below.reserve(graph.edges.neighbours.size());  // about; pages are touched once
  }

  FundamentalSupernodes all()
  {
    for (int j = 0; j < std::ssize(found_.order); ++j) {
      const int child = first_child_[j];
      const bool is_only = child != none && sibling_[child] == none;
      if (is_only && has_neighbours_below(j, child))
        ++found_.below_first[child];  // without j, which is its newest column
      else
        add(j);
      if (const int s = found_.size() - 1; !found_.below_of(s).empty()) wait(s);
    }
    found_.first_column.push_back(static_cast<int>(found_.order.size()));
    return std::move(found_);
  }

 private:
  static constexpr int none = -1;

  std::span<const int> neighbours(int j) const
  {
    const int v = found_.order[j], first = graph_.edges.starts[v];
    return std::span(graph_.edges.neighbours)
        .subspan(std::size_t(first), std::size_t(graph_.edges.starts[v + 1] - first));
  }

  /// Whether all that column j is joined to later is below the newest supernode.
  bool has_neighbours_below(int j, int s) const
  {
    return std::ranges::all_of(neighbours(j), [&](int v) {
      const int i = place_[v];
      return i <= j || seen_by_[i] == s;
    });
  }

  /// s becomes a child of the first column below it.
  void wait(int s)
  {
    int& first = first_child_[found_.below_of(s).front()];
    sibling_[s] = std::exchange(first, s);
  }

  /// A supernode that begins with column j. Below it are its neighbours, and what its children hand
  /// on. The longest of these lists, which ascend, is most of it.
  void add(int j)
  {
    const int s = found_.size();
    std::vector<int>& below = found_.below;
    const std::size_t first = below.size();
    const auto take = [&](int i) {
      if (i <= j || seen_by_[i] == s) return;
      seen_by_[i] = s;
      below.push_back(i);
    };
    const auto take_child = [&](int child) {
      for (std::size_t k = found_.below_first[child]; k < found_.below_last[child]; ++k)
        take(below[k]);
    };
    int longest = none;
    for (int child = first_child_[j]; child != none; child = sibling_[child]) {
      found_.parent[child] = s;
      if (longest == none || found_.below_of(child).size() > found_.below_of(longest).size())
        longest = child;
    }
    if (longest != none) take_child(longest);
    const auto n_sorted = std::ssize(below);
    for (const int v : neighbours(j)) take(place_[v]);
    for (int child = first_child_[j]; child != none; child = sibling_[child])
      if (child != longest) take_child(child);
    const auto begin = below.begin() + std::ptrdiff_t(first), middle = below.begin() + n_sorted;
    std::sort(middle, below.end());
    std::inplace_merge(begin, middle, below.end());
    found_.first_column.push_back(j);
    found_.parent.push_back(none);
    found_.below_first.push_back(first);
    found_.below_last.push_back(below.size());
    sibling_.push_back(none);
  }

  const QuotientGraph& graph_;
  std::vector<int> place_;        ///< of each vertex
  std::vector<int> seen_by_;      ///< last supernode that a place is below of
  std::vector<int> first_child_;  ///< of each column: a supernode whose parent begins with it
  std::vector<int> sibling_;      ///< of each supernode
  FundamentalSupernodes found_;
};

FundamentalSupernodes fundamental_supernodes(const QuotientGraph& graph,
                                             const std::vector<int>& wanted)
{
  std::vector<int> order;
  order.reserve(wanted.size());
  for (const int place : postorder(elimination_tree(graph, wanted))) order.push_back(wanted[place]);
  return Structures(graph, std::move(order)).all();
}

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
