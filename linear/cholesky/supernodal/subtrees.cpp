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

}  // namespace

std::vector<int> share_subtrees(const AssemblyTree& tree, int n_ranks)
{
  const int n = tree.n_supernodes();
  if (n_ranks == 1) return std::vector<int>(n, 0);
  std::vector<double> work_below(n, 0.0);
  std::vector<std::vector<int>> children(n);
  std::vector<int> roots;
  for (int s = 0; s < n; ++s) {
    work_below[s] += work(tree, s);
    if (tree.parent[s] == -1) {
      roots.push_back(s);
    } else {
      work_below[tree.parent[s]] += work_below[s];
      children[tree.parent[s]].push_back(s);
    }
  }
  // Splitting a subtree makes its root everybody's: as long as that shortens the longest path.
  std::vector<int> best(n, all_ranks);
  double common = 0.0,
         shortest = std::accumulate(roots.begin(), roots.end(), 0.0,
                                    [&](double sum, int s) { return sum + work_below[s]; });
  while (!roots.empty() && common < shortest) {
    std::ranges::sort(roots, [&](int a, int b) { return work_below[a] > work_below[b]; });
    double fullest = 0.0;
    const std::vector<int> owner = owners(roots, work_below, n_ranks, fullest);
    if (common + fullest < shortest) {
      shortest = common + fullest;
      std::ranges::fill(best, all_ranks);
      for (std::size_t i = 0; i < roots.size(); ++i) best[roots[i]] = owner[i];
    }
    const int split = roots.front();
    common += work(tree, split);
    roots.erase(roots.begin());
    roots.insert(roots.end(), children[split].begin(), children[split].end());
  }
  for (int s = n - 1; s >= 0; --s)  // from the roots of subtrees down
    if (tree.parent[s] != -1 && best[tree.parent[s]] != all_ranks) best[s] = best[tree.parent[s]];
  return best;
}

}  // namespace chladni::linear
