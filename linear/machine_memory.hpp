#pragma once

#include <mpi.h>

#include <limits>
#include <string>

/// Whether what comes next fits into the memory of each machine, before it is taken.
namespace chladni::linear {

inline constexpr double bytes_in_MiB = 1048576.0;

/// MiB of one machine.
struct MemoryNeed {
  double needed_MiB;  ///< by all ranks that are on it
  double free_MiB = std::numeric_limits<double>::infinity();
  bool fits() const { return needed_MiB <= free_MiB; }
};

/// MiB that processes may still take on this machine, by the kernel's estimate.
double free_MiB();

/// What was freed goes back from the heap to the machine, in pieces of any size.
void give_back_freed();

/// The machine that lacks most, or where least is left over.
/// @param own_MiB   that this rank needs
/// @param free_MiB  on its machine
/// @return the same on all ranks.
/// @note   Collective on `comm`.
MemoryNeed tightest_machine(double own_MiB, double free_MiB, MPI_Comm comm);

/// @param own_MiB  that this rank is about to take
/// @param what     "the basis of block Lanczos"
/// @param cure     "ask for fewer modes"
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks when a machine has less than its ranks need.
void require_memory(double own_MiB, const std::string& what, const std::string& cure,
                    MPI_Comm comm);

}  // namespace chladni::linear
