#include "cases/ranks.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdint>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"

namespace chladni::cases {

namespace {

double reduce_over_ranks(double x, MPI_Op operation)
{
  double result = x;
  MPI_Allreduce(&x, &result, 1, MPI_DOUBLE, operation, PETSC_COMM_WORLD);
  return result;
}

}  // namespace

int rank()
{
  return petsc::rank(PETSC_COMM_WORLD);
}

int n_ranks()
{
  return petsc::size(PETSC_COMM_WORLD);
}

double sum_over_ranks(double x)
{
  return reduce_over_ranks(x, MPI_SUM);
}

double largest_of_ranks(double x)
{
  return reduce_over_ranks(x, MPI_MAX);
}

std::vector<double> joined(const std::vector<double>& own)
{
  const auto n = static_cast<int>(own.size());
  const auto ranks = static_cast<std::size_t>(n_ranks());
  std::vector<int> sizes(ranks), starts(ranks, 0);
  MPI_Allgather(&n, 1, MPI_INT, sizes.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (std::size_t r = 1; r < sizes.size(); ++r) starts[r] = starts[r - 1] + sizes[r - 1];
  std::vector<double> all(static_cast<std::size_t>(starts.back() + sizes.back()));
  MPI_Allgatherv(own.data(), n, MPI_DOUBLE, all.data(), sizes.data(), starts.data(), MPI_DOUBLE,
                 PETSC_COMM_WORLD);
  return all;
}

void on_first_rank(const std::function<void()>& work)
{
  chladni::on_first_rank(PETSC_COMM_WORLD, work);
}

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
