// Trees of a SupernodalFactor, and rows that can be solved for without the others.
#include <algorithm>

#include "common/index_sets.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"

namespace chladni::linear {

void SupernodalFactor::number_trees()
{
  tree_of_.assign(tree_.n_supernodes(), 0);
  for (int s = tree_.n_supernodes() - 1; s >= 0; --s)
    tree_of_[s] = tree_.parent[s] == -1 ? s : tree_of_[tree_.parent[s]];
}

int SupernodalFactor::supernode_at(int position) const
{
  const auto behind = std::ranges::upper_bound(tree_.first_column, position);
  return static_cast<int>(behind - tree_.first_column.begin()) - 1;
}

int SupernodalFactor::supernode_of_row(PetscInt row) const
{
  return supernode_at(tree_.position[row]);
}

Supernodes SupernodalFactor::of_trees(const std::vector<char>& roots) const
{
  Supernodes found{.own = {}, .shared = std::vector<std::vector<int>>(groups_.size())};
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    if (roots[tree_of_[s]] == 0 || !group_[s].has(rank_)) continue;
    (group_[s].size() == 1 ? found.own : found.shared[level_of(s)]).push_back(s);
  }
  return found;
}

SlotExchange SupernodalFactor::exchange_of(const std::vector<int>& own_rows,
                                           const Supernodes& supernodes) const
{
  RowSlots slots{.group = [&](int row) { return group_[supernode_of_row(row)]; },
                 .slot = [&](int row) { return slot_[tree_.position[row]]; },
                 .here = {}};
  const auto add = [&](const std::vector<int>& some) {
    for (const int s : some)
      for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p)
        slots.here.push_back(slot_[p]);
  };
  add(supernodes.own);
  std::ranges::for_each(supernodes.shared, add);
  return {comm_, own_rows, slots};
}

SupernodalPart SupernodalFactor::part(IS rows) const
{
  const std::vector<int> own = petsc::own_indices(rows);
  std::vector<char> roots(tree_.n_supernodes(), 0);
  for (const int row : own) roots[tree_of_[supernode_of_row(row)]] = 1;
  MPI_Allreduce(MPI_IN_PLACE, roots.data(), tree_.n_supernodes(), MPI_SIGNED_CHAR, MPI_MAX, comm_);
  auto n_rows = static_cast<int>(own.size());
  MPI_Allreduce(MPI_IN_PLACE, &n_rows, 1, MPI_INT, MPI_SUM, comm_);
  int n_coupled = 0;
  for (int s = 0; s < tree_.n_supernodes(); ++s)
    if (roots[tree_of_[s]] != 0) n_coupled += tree_.n_columns(s);
  if (n_coupled != n_rows) {
    throw Error(fmt::format(
        "SupernodalFactor::part: the {} rows of a part are coupled to {} others; take all of them",
        n_rows, n_coupled - n_rows));
  }
  SupernodalPart part{.supernodes = of_trees(roots), .exchange = {}};
  part.exchange = exchange_of(own, part.supernodes);
  return part;
}

}  // namespace chladni::linear
