#include "cases/harmonic_groups.hpp"

#include <algorithm>
#include <cstdint>

#include "cases/ranks.hpp"
#include "common/petsc.hpp"

namespace chladni::cases {

HarmonicGroups::HarmonicGroups(int n_harmonics, std::optional<int> ranks_each)
    : n_groups_(std::clamp(n_ranks() / ranks_each.value_or(1), 1, n_harmonics)),
      group_(static_cast<int>(std::int64_t{rank()} * n_groups_ / n_ranks()))
{
  MPI_Comm_split(PETSC_COMM_WORLD, group_, rank(), &comm_);
  for (int order = group_; order < n_harmonics; order += n_groups_) own_.push_back(order);
}

HarmonicGroups::~HarmonicGroups()
{
  MPI_Comm_free(&comm_);
}

int HarmonicGroups::speaker(int order) const
{
  const std::int64_t group = order % n_groups_;
  return static_cast<int>((group * n_ranks() + n_groups_ - 1) / n_groups_);
}

bool HarmonicGroups::speaks() const
{
  return petsc::rank(comm_) == 0;
}

}  // namespace chladni::cases
