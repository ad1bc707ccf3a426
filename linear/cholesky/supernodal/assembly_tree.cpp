#include "linear/cholesky/supernodal/assembly_tree.hpp"

#include <algorithm>
#include <numeric>

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
  Amalgamation(const QuotientGraph& graph, std::vector<FundamentalSupernode> supernodes)
      : graph_(graph), supernodes_(std::move(supernodes)), children_(supernodes_.size())
  {
    for (int s = 0; s < std::ssize(supernodes_); ++s) {
      columns_.push_back(rows_of(supernodes_[s].columns));
      below_.push_back(rows_of(supernodes_[s].below));
      entries_.push_back(trapezoid(columns_[s], below_[s]));
      if (supernodes_[s].parent != -1) children_[supernodes_[s].parent].push_back(s);
    }
    for (int s = 0; s < std::ssize(supernodes_); ++s) take_up_children(s);
  }

  /// What is left, children before parents.
  std::vector<int> postorder() const
  {
    std::vector<int> order;
    std::vector<std::pair<int, std::size_t>> stack;
    for (int root = 0; root < std::ssize(supernodes_); ++root) {
      if (supernodes_[root].parent != -1) continue;
      stack.emplace_back(root, 0);
      while (!stack.empty()) {
        auto& [s, next] = stack.back();
        if (next < children_[s].size()) {
          stack.emplace_back(children_[s][next++], 0);
        } else {
          order.push_back(s);
          stack.pop_back();
        }
      }
    }
    return order;
  }

  const FundamentalSupernode& operator[](int s) const { return supernodes_[s]; }
  const std::vector<int>& children(int s) const { return children_[s]; }

 private:
  double rows_of(const std::vector<int>& vertices) const
  {
    return std::accumulate(vertices.begin(), vertices.end(), 0.0,
                           [&](double sum, int v) { return sum + graph_.n_rows[v]; });
  }

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
    std::vector<int> candidates = std::move(children_[s]), left;
    children_[s].clear();
    std::ranges::sort(candidates, [&](int a, int b) { return below_[a] > below_[b]; });
    for (const int child : candidates) {
      if (!pays(child, s)) {
        left.push_back(child);
        continue;
      }
      std::vector<int>& taken = supernodes_[child].columns;
      std::vector<int>& columns = supernodes_[s].columns;
      columns.insert(columns.begin(), taken.begin(), taken.end());
      columns_[s] += columns_[child];
      entries_[s] += entries_[child];
      left.insert(left.end(), children_[child].begin(), children_[child].end());
    }
    for (const int child : left) supernodes_[child].parent = s;
    children_[s] = std::move(left);
  }

  const QuotientGraph& graph_;
  std::vector<FundamentalSupernode> supernodes_;
  std::vector<std::vector<int>> children_;
  std::vector<double> columns_, below_;  ///< rows of the matrix
  std::vector<double> entries_;          ///< without the stored zeros
};

/// The vertices in the order of their first rows' places.
std::vector<int> order_of_vertices(const QuotientGraph& graph, const std::vector<int>& places)
{
  std::vector<int> first_place(graph.n_vertices(), static_cast<int>(places.size()) + 1);
  for (std::size_t row = 0; row < places.size(); ++row) {
    int& first = first_place[graph.vertex_of_row[row]];
    first = std::min(first, places[row]);
  }
  std::vector<int> order(graph.n_vertices());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](int a, int b) { return first_place[a] < first_place[b]; });
  return order;
}

std::vector<std::vector<int>> rows_of_vertices(const QuotientGraph& graph)
{
  std::vector<std::vector<int>> rows(graph.n_vertices());
  for (std::size_t row = 0; row < graph.vertex_of_row.size(); ++row)
    rows[graph.vertex_of_row[row]].push_back(static_cast<int>(row));
  return rows;
}

}  // namespace

double AssemblyTree::n_entries(int s) const
{
  return trapezoid(n_columns(s), double(below(s).size()));
}

double AssemblyTree::n_operations(int s) const
{
  const double w = n_columns(s);
  const auto m = double(below(s).size());
  return w * w * w / 3.0 + w * w * m + w * m * m;
}

AssemblyTree assembly_tree(const QuotientGraph& graph, const std::vector<int>& places)
{
  const Amalgamation supernodes(graph,
                                fundamental_supernodes(graph, order_of_vertices(graph, places)));
  const std::vector<std::vector<int>> rows = rows_of_vertices(graph);
  const std::vector<int> order = supernodes.postorder();
  AssemblyTree tree{.position = std::vector<int>(places.size()),
                    .row = {},
                    .first_column = {0},
                    .parent = std::vector<int>(order.size(), -1),
                    .below_starts = {0},
                    .below_rows = {}};
  std::vector<int> number(order.empty() ? 0 : *std::ranges::max_element(order) + 1, -1);
  for (int s = 0; s < std::ssize(order); ++s) {
    for (const int v : supernodes[order[s]].columns) {
      for (const int r : rows[v]) {
        tree.position[r] = static_cast<int>(tree.row.size());
        tree.row.push_back(r);
      }
    }
    tree.first_column.push_back(static_cast<int>(tree.row.size()));
    number[order[s]] = s;
  }
  for (int s = 0; s < std::ssize(order); ++s) {
    for (const int child : supernodes.children(order[s])) tree.parent[number[child]] = s;
    for (const int v : supernodes[order[s]].below)
      for (const int r : rows[v]) tree.below_rows.push_back(tree.position[r]);
    std::sort(tree.below_rows.begin() + std::ptrdiff_t(tree.below_starts.back()),
              tree.below_rows.end());
    tree.below_starts.push_back(tree.below_rows.size());
  }
  return tree;
}

}  // namespace chladni::linear
