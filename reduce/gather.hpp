#pragma once

#include <numeric>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::reduce {

/// Where the list of each rank begins when the lists stand one behind the other.
inline std::vector<int> offsets(const std::vector<int>& counts)
{
  std::vector<int> at(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), at.begin(), 0);
  return at;
}

/// What all ranks have, in their order; on rank 0 only.
/// @note   Collective on `comm`.
template <typename T>
std::vector<T> gather(const std::vector<T>& own, MPI_Datatype type, MPI_Comm comm)
{
  const auto n = static_cast<int>(own.size());
  std::vector<int> counts(petsc::size(comm));
  MPI_Gather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm);
  const std::vector<int> at = offsets(counts);
  std::vector<T> all(petsc::rank(comm) == 0 ? at.back() + counts.back() : 0);
  MPI_Gatherv(own.data(), n, type, all.data(), counts.data(), at.data(), type, 0, comm);
  return all;
}

/// The same on all ranks.
template <typename T>
std::vector<T> gather_on_all(const std::vector<T>& own, MPI_Datatype type, MPI_Comm comm)
{
  const auto n = static_cast<int>(own.size());
  std::vector<int> counts(petsc::size(comm));
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  const std::vector<int> at = offsets(counts);
  std::vector<T> all(at.back() + counts.back());
  MPI_Allgatherv(own.data(), n, type, all.data(), counts.data(), at.data(), type, comm);
  return all;
}

}  // namespace chladni::reduce
