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

/// Symbolic factorisation, column by column in postorder.
class Structures {
 public:
  Structures(const QuotientGraph& graph, const std::vector<int>& order)
      : graph_(graph), order_(order), place_(inverse(order)), seen_by_(order.size(), -1)
  {}

  /// Places below column j, ascending: its neighbours, and what its children hand on. The longest
  /// of these lists, which ascend, is most of it.
  std::vector<int> below(int j, const std::vector<const std::vector<int>*>& of_children)
  {
    std::vector<int> result;
    const auto add = [&](int i) {
      if (i <= j || seen_by_[i] == j) return;
      seen_by_[i] = j;
      result.push_back(i);
    };
    const auto longest = std::ranges::max_element(
        of_children, {}, [](const std::vector<int>* child) { return child->size(); });
    if (longest != of_children.end()) {
      result.reserve((*longest)->size());
      std::ranges::for_each(**longest, add);
    }
    const auto n_sorted = std::ssize(result);
    for (int k = graph_.edges.starts[order_[j]]; k < graph_.edges.starts[order_[j] + 1]; ++k)
      add(place_[graph_.edges.neighbours[k]]);
    for (auto child = of_children.begin(); child != of_children.end(); ++child)
      if (child != longest) std::ranges::for_each(**child, add);
    std::sort(result.begin() + n_sorted, result.end());
    std::inplace_merge(result.begin(), result.begin() + n_sorted, result.end());
    return result;
  }

 private:
  const QuotientGraph& graph_;
  const std::vector<int>& order_;
  std::vector<int> place_, seen_by_;
};

}  // namespace

std::vector<FundamentalSupernode> fundamental_supernodes(const QuotientGraph& graph,
                                                         const std::vector<int>& wanted)
{
  std::vector<int> order;
  for (const int place : postorder(elimination_tree(graph, wanted))) order.push_back(wanted[place]);
  Structures structures(graph, order);
  std::vector<FundamentalSupernode> supernodes;
  std::vector<std::vector<int>> children(order.size());  // supernodes whose parent is this column
  for (int j = 0; j < std::ssize(order); ++j) {
    std::vector<const std::vector<int>*> of_children;
    for (const int child : children[j]) of_children.push_back(&supernodes[child].below);
    std::vector<int> below = structures.below(j, of_children);
    int self = children[j].size() == 1 ? children[j][0] : -1;
    if (self == -1 || supernodes[self].below.size() != below.size() + 1) {
      self = static_cast<int>(supernodes.size());
      for (const int child : children[j]) supernodes[child].parent = self;
      supernodes.emplace_back();
    }
    supernodes[self].columns.push_back(j);
    supernodes[self].below = std::move(below);
    const std::vector<int>& under = supernodes[self].below;
    if (!under.empty()) children[under[0]].push_back(self);
  }
  for (FundamentalSupernode& s : supernodes) {
    for (int& column : s.columns) column = order[column];
    for (int& row : s.below) row = order[row];
  }
  return supernodes;
}

}  // namespace chladni::linear
