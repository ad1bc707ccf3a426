#include "linear/cholesky/supernodal/rank_groups.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include "linear/cholesky/supernodal/tiled_columns.hpp"

namespace chladni::linear {

namespace {

/// Most of the time goes into some hundred solutions. They are made in blocks, in each of which the
/// ranks that share a supernode wait for each other twice.
double work(const AssemblyTree& tree, int s, int n_ranks = 1)
{
  constexpr double solved_columns = 500.0;
  constexpr double operations_while_waiting = 2e6;  // in all blocks, for each doubling of the ranks
  return operations_of_rank(tree, s, n_ranks) + 4.0 * solved_columns * tree.n_entries(s) / n_ranks +
         operations_while_waiting * std::bit_width(unsigned(n_ranks - 1));
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

double work_of_roots(const std::vector<int>& roots, const std::vector<double>& work_below)
{
  return std::accumulate(roots.begin(), roots.end(), 0.0,
                         [&](double sum, int s) { return sum + work_below[s]; });
}

/// Trees that make up a good part of the work stand alone, the others together: each of these may
/// be solved without the rest, and then all ranks must have something of it.
std::vector<std::vector<int>> solved_apart(const Subtrees& all)
{
  constexpr double good_part = 1.0 / 16.0;
  const double large = good_part * work_of_roots(all.roots, all.work_below);
  std::vector<std::vector<int>> groups(1);
  for (const int root : all.roots)
    if (all.work_below[root] < large)
      groups.front().push_back(root);
    else
      groups.push_back({root});
  return groups;
}

/// The two halves of a group.
std::pair<RankGroup, RankGroup> halves(const RankGroup& group)
{
  const int middle = group.first + (group.size() + 1) / 2;
  return {{group.first, middle}, {middle, group.last}};
}

/// Subtrees for each half of a group, the largest first to the half whose ranks have least.
struct Halved {
  std::vector<int> first, second;
  double path = 0.0;  ///< work of a rank of the half that has most, if it can be shared evenly
};

Halved halved(const std::vector<int>& roots, const Subtrees& all, const RankGroup& group)
{
  const auto [first, second] = halves(group);
  Halved made;
  double of_first = 0.0, of_second = 0.0;
  for (const int root : roots) {
    const bool is_first = of_first <= of_second;
    (is_first ? made.first : made.second).push_back(root);
    (is_first ? of_first : of_second) +=
        all.work_below[root] / (is_first ? first.size() : second.size());
  }
  made.path = std::max(of_first, of_second);
  return made;
}

/// Splitting a subtree makes its root a matter of the whole group: as long as that shortens the
/// longest path. What is left goes to the halves.
/// @param owner  [n_supernodes] of the roots of subtrees: a rank, and of what stands above them
void share(std::vector<int> roots, const Subtrees& all, const RankGroup& group,
           std::vector<RankGroup>& owner)
{
  const auto give = [&](int s) { owner[s] = group; };
  if (group.size() == 1) {
    std::ranges::for_each(roots, give);
    return;
  }
  double common = 0.0, left = work_of_roots(roots, all.work_below);
  double shortest = std::numeric_limits<double>::infinity();
  std::vector<int> above, best_above;
  Halved best;
  while (!roots.empty() && common + left / group.size() < shortest) {
    std::ranges::sort(roots, [&](int a, int b) { return all.work_below[a] > all.work_below[b]; });
    Halved now = halved(roots, all, group);
    if (common + now.path < shortest) {
      shortest = common + now.path;
      best = std::move(now);
      best_above = above;
    }
    const int split = roots.front();
    common += work(all.tree, split, group.size());
    left -= work(all.tree, split);
    above.push_back(split);
    roots.erase(roots.begin());
    roots.insert(roots.end(), all.children[split].begin(), all.children[split].end());
  }
  std::ranges::for_each(best_above, give);
  const auto [first, second] = halves(group);
  share(std::move(best.first), all, first, owner);
  share(std::move(best.second), all, second, owner);
}

}  // namespace

double operations_of_rank(const AssemblyTree& tree, int s, int n_ranks)
{
  if (n_ranks == 1) return tree.n_operations(s);
  const double w = tree.n_columns(s);
  const double m = tree.n_below[s];
  const double block = std::min(w, double(columns_together));
  return (tree.n_operations(s) + w * w * w / 3.0 + w * w * m) / n_ranks + w * block * block / 3.0;
}

double entries_of_rank(const AssemblyTree& tree, int s, const RankGroup& group, int place)
{
  if (group.size() == 1) return tree.n_entries(s);
  return double(shared_size(dealt_rows(tree, s, group), place));
}

std::vector<RankGroup> groups_of(int rank, int n_ranks)
{
  std::vector<RankGroup> groups;
  for (RankGroup group{.first = 0, .last = n_ranks}; group.size() > 1;) {
    groups.push_back(group);
    const auto [first, second] = halves(group);
    group = first.has(rank) ? first : second;
  }
  std::ranges::reverse(groups);
  return groups;
}

std::vector<RankGroup> share_subtrees(const AssemblyTree& tree, int n_ranks)
{
  const int n = tree.n_supernodes();
  const RankGroup everybody{.first = 0, .last = n_ranks}, nobody{.first = 0, .last = 0};
  if (n_ranks == 1) return std::vector<RankGroup>(n, everybody);
  std::vector<RankGroup> owner(n, nobody);
  const Subtrees all = subtrees(tree);
  for (const std::vector<int>& roots : solved_apart(all)) share(roots, all, everybody, owner);
  for (int s = n - 1; s >= 0; --s)  // from the roots of subtrees down
    if (owner[s] == nobody) owner[s] = owner[tree.parent[s]];
  return owner;
}

std::vector<char> seen_by(int rank, const AssemblyTree& tree, const std::vector<RankGroup>& group)
{
  std::vector<char> is_seen;
  for (int s = 0; s < tree.n_supernodes(); ++s) {
    const int parent = tree.parent[s];
    is_seen.push_back(group[s].has(rank) || (parent != -1 && group[parent].has(rank)) ? 1 : 0);
  }
  return is_seen;
}

}  // namespace chladni::linear
