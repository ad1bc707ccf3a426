#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "common/checked_count.hpp"
#include "common/petsc.hpp"

namespace chladni::linear {

/// An MPI type of n_numbers doubles, with which MPI counts rows of a panel instead of numbers.
class RowType {
 public:
  explicit RowType(int n_numbers)
  {
    MPI_Type_contiguous(n_numbers, MPI_DOUBLE, &type_);
    MPI_Type_commit(&type_);
  }
  ~RowType() { MPI_Type_free(&type_); }
  RowType(const RowType&) = delete;
  RowType& operator=(const RowType&) = delete;
  operator MPI_Datatype() const { return type_; }  // NOLINT(google-explicit-constructor): as MPI's

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

/// The start of each rank's list when the lists of all ranks are concatenated, followed by the end.
/// @throws chladni::Error when they hold more numbers than a call of MPI can count.
inline std::vector<int> offsets(const std::vector<int>& counts)
{
  checked_count(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}),
                "numbers for one call of MPI", "use more ranks, or a coarser mesh");
  std::vector<int> at(counts.size() + 1, 0);
  std::inclusive_scan(counts.begin(), counts.end(), at.begin() + 1);
  return at;
}

/// The first of the numbers of this rank, where the ranks count one after the other.
/// @note   Collective on `comm`.
inline int first_number(int n_own, MPI_Comm comm)
{
  int first = 0;
  MPI_Exscan(&n_own, &first, 1, MPI_INT, MPI_SUM, comm);
  return petsc::rank(comm) == 0 ? 0 : first;
}

/// The number of values of each rank, on all ranks.
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks when one has more than a call of MPI can count.
inline std::vector<int> counts_of_ranks(std::size_t own, MPI_Comm comm)
{
  const auto n = static_cast<std::int64_t>(own);
  std::vector<std::int64_t> counts(petsc::size(comm));
  MPI_Allgather(&n, 1, MPI_INT64_T, counts.data(), 1, MPI_INT64_T, comm);
  std::vector<int> checked;
  for (const std::int64_t count : counts) {
    checked.push_back(
        checked_count(count, "numbers of one rank", "use more ranks, or a coarser mesh"));
  }
  return checked;
}

/// The values of all ranks in their order, on rank 0 only.
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks, before anything is allocated, when there are more than a
///         call of MPI can count.
template <typename T>
std::vector<T> gather(std::vector<T> own, MPI_Datatype type, MPI_Comm comm)
{
  const std::vector<int> counts = counts_of_ranks(own.size(), comm);
  if (counts.size() == 1) return own;
  const std::vector<int> at = offsets(counts);
  std::vector<T> all(petsc::rank(comm) == 0 ? at.back() : 0);
  MPI_Gatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.data(), at.data(),
              type, 0, comm);
  return all;
}

/// The values of all ranks in their order, on every rank.
/// @note   Collective on `comm`.
/// @throws chladni::Error as `gather`.
template <typename T>
std::vector<T> gather_on_all(std::vector<T> own, MPI_Datatype type, MPI_Comm comm)
{
  const std::vector<int> counts = counts_of_ranks(own.size(), comm);
  if (counts.size() == 1) return own;
  const std::vector<int> at = offsets(counts);
  std::vector<T> all(at.back());
  MPI_Allgatherv(own.data(), static_cast<int>(own.size()), type, all.data(), counts.data(),
                 at.data(), type, comm);
  return all;
}

}  // namespace chladni::linear
