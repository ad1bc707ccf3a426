#include "linear/cholesky/supernodal/subtrees.hpp"

#include <algorithm>
#include <numeric>

namespace chladni::linear {

namespace {

/// Most of the time goes into some hundred solutions.
double work(const AssemblyTree& tree, int s)
{
  constexpr double solved_columns = 500.0;
  return tree.n_operations(s) + 4.0 * solved_columns * tree.n_entries(s);
}

/// The largest first, each to the rank that has least.
std::vector<int> owners(const std::vector<int>& roots, const std::vector<double>& work_below,
                        int n_ranks, double& fullest)
{
  std::vector<double> load(n_ranks, 0.0);
  std::vector<int> owner;
  for (const int root : roots) {
    const auto least = std::ranges::min_element(load);
    *least += work_below[root];
    owner.push_back(static_cast<int>(least - load.begin()));
  }
  fullest = *std::ranges::max_element(load);
  return owner;
}

/// What hangs together in an assembly tree, and the work in each subtree.
struct Subtrees {
  const AssemblyTree& tree;
  std::vector<double> work_below;
  std::vector<std::vector<int>> children;
  std::vector<int> roots;
};

Subtrees subtrees(const AssemblyTree& tree)
{
  const int n = tree.n_supernodes();
  Subtrees all{.tree = tree,
               .work_below = std::vector<double>(n, 0.0),
               .children = std::vector<std::vector<int>>(n),
               .roots = {}};
  for (int s = 0; s < n; ++s) {
    all.work_below[s] += work(tree, s);
    if (tree.parent[s] == -1) {
      all.roots.push_back(s);
    } else {
      all.work_below[tree.parent[s]] += all.work_below[s];
      all.children[tree.parent[s]].push_back(s);
    }
  }
  return all;
}

double sum(const std::vector<int>& roots, const std::vector<double>& work_below)
{
  return std::accumulate(roots.begin(), roots.end(), 0.0,
                         [&](double sum, int s) { return sum + work_below[s]; });
}

/// Trees that make up a good part of the work stand alone, the others together: each of these may
/// be solved without the rest, and then all ranks must have something of it.
std::vector<std::vector<int>> solved_apart(const Subtrees& all)
{
  constexpr double good_part = 1.0 / 16.0;
  const double large = good_part * sum(all.roots, all.work_below);
  std::vector<std::vector<int>> groups(1);
  for (const int root : all.roots)
    if (all.work_below[root] < large)
      groups.front().push_back(root);
    else
      groups.push_back({root});
  return groups;
}

/// Splitting a subtree makes its root everybody's: as long as that shortens the longest path.
/// @param owner  [n_supernodes] of the roots of subtrees: a rank, if they get one
void share(std::vector<int> roots, const Subtrees& all, int n_ranks, std::vector<int>& owner)
{
  double common = 0.0, shortest = sum(roots, all.work_below);
  std::vector<int> best_roots, best;
  while (!roots.empty() && common < shortest) {
    std::ranges::sort(roots, [&](int a, int b) { return all.work_below[a] > all.work_below[b]; });
    double fullest = 0.0;
    const std::vector<int> some = owners(roots, all.work_below, n_ranks, fullest);
    if (common + fullest < shortest) {
      shortest = common + fullest;
      best_roots = roots;
      best = some;
    }
    const int split = roots.front();
    common += work(all.tree, split);
    roots.erase(roots.begin());
    roots.insert(roots.end(), all.children[split].begin(), all.children[split].end());
  }
  for (std::size_t i = 0; i < best.size(); ++i) owner[best_roots[i]] = best[i];
}

}  // namespace

std::vector<int> share_subtrees(const AssemblyTree& tree, int n_ranks)
{
  const int n = tree.n_supernodes();
  if (n_ranks == 1) return std::vector<int>(n, 0);
  std::vector<int> owner(n, all_ranks);
  const Subtrees all = subtrees(tree);
  for (const std::vector<int>& roots : solved_apart(all)) share(roots, all, n_ranks, owner);
  for (int s = n - 1; s >= 0; --s) {  // from the roots of subtrees down
    const int parent = tree.parent[s];
    if (parent != -1 && owner[parent] != all_ranks) owner[s] = owner[parent];
  }
  return owner;
}

}  // namespace chladni::linear
