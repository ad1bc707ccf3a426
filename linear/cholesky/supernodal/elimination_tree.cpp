#include "linear/cholesky/supernodal/elimination_tree.hpp"

#include <algorithm>
#include <utility>

namespace chladni::linear {

namespace {

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

}  // namespace

FundamentalSupernodes fundamental_supernodes(const QuotientGraph& graph,
                                             const std::vector<int>& wanted)
{
  std::vector<int> order;
  order.reserve(wanted.size());
  for (const int place : postorder(elimination_tree(graph, wanted))) order.push_back(wanted[place]);
  return Structures(graph, std::move(order)).all();
}

}  // namespace chladni::linear
