#pragma once

#include <mpi.h>

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <type_traits>

#include "common/error.hpp"

namespace chladni {

/// Throws on all ranks the complaint of the lowest rank that has one.
/// @note   Collective on `comm`.
/// @throws chladni::Error with the complaint.
inline void agree_on(const std::optional<std::string>& complaint, MPI_Comm comm)
{
  int rank = 0, none = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &none);
  int speaker = complaint ? rank : none;
  MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, comm);
  if (speaker == none) return;
  std::string text = complaint.value_or("");
  auto size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, speaker, comm);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, speaker, comm);
  throw Error(text);
}

/// Its words; of memory that ran out, whose own are the name of a class, ours.
inline std::string complaint_of(const std::exception& error)
{
  if (dynamic_cast<const std::bad_alloc*>(&error) == nullptr) return error.what();
  return "not enough memory on a rank; use more machines, ask for less, or raise the limit of this "
         "shell (ulimit -v)";
}

/// Runs work() on each rank. It must not communicate. If it throws on one rank, all ranks throw, so
/// that none waits for the others.
/// @return the result of work() on this rank
/// @note   Collective on `comm`.
/// @throws chladni::Error when work() threw on any rank.
template <typename Work>
auto on_all_ranks(MPI_Comm comm, const Work& work)
{
  std::optional<std::string> complaint;
  std::optional<std::invoke_result_t<Work>> result;
  try {
    result.emplace(work());
  } catch (const std::exception& error) {
    complaint = complaint_of(error);
  }
  agree_on(complaint, comm);
  return std::move(*result);
}

/// Runs work() on the first rank alone. The others wait, and throw what it throws.
/// @note   Collective on `comm`.
/// @throws chladni::Error when work() threw.
template <typename Work>
void on_first_rank(MPI_Comm comm, const Work& work)
{
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::optional<std::string> complaint;
  if (rank == 0) {
    try {
      work();
    } catch (const std::exception& error) {
      complaint = complaint_of(error);
    }
  }
  agree_on(complaint, comm);
}

}  // namespace chladni
