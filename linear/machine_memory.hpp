#pragma once

#include <mpi.h>

#include <filesystem>
#include <limits>
#include <string>

/// Checks that the next step fits into the memory of each machine, before the memory is taken.
namespace chladni::linear {

inline constexpr double bytes_in_MiB = 1048576.0;

/// Memory needed and free on one machine.
struct MemoryNeed {
  double needed_MiB;  ///< by all ranks on the machine
  double free_MiB = std::numeric_limits<double>::infinity();
  bool fits() const { return needed_MiB <= free_MiB; }
};

/// MiB that processes may still take on this machine, by the kernel's estimate, or fewer where the
/// control group of this process, as of a container or a job of a cluster, may take no more.
double free_MiB();

/// Where the kernel says what a control group may take, and what it has taken.
struct ControlGroups {
  std::filesystem::path groups = "/proc/self/cgroup";  ///< those of this process
  std::filesystem::path root = "/sys/fs/cgroup";       ///< of their files, versions 1 and 2
};

/// MiB that the control groups of this process and those above them let it take; infinity where
/// they set no limit. Cached files do not count as taken: the kernel drops them first.
/// Source: Linux, Documentation/admin-guide/cgroup-v1/memory.rst and cgroup-v2.rst.
double free_MiB_of_control_group(const ControlGroups& where = {});

/// Returns freed heap memory to the operating system, in pieces of any size.
void give_back_freed();

/// What is free in the heap of this process, also what has been given back, MiB.
double freed_MiB();

/// What this process has in memory, MiB; zero where the system does not tell.
double resident_MiB();

/// The machine that lacks most or, if none lacks memory, has the least left.
/// @param own_MiB   needed by this rank
/// @param free_MiB  free on its machine
/// @return the same on all ranks
/// @note   Collective on `comm`.
MemoryNeed tightest_machine(double own_MiB, double free_MiB, MPI_Comm comm);

/// Checks that each machine has the memory that its ranks need.
/// @param own_MiB  needed by this rank
/// @param what     what needs it, "the basis of block Lanczos"
/// @param cure     what to do, "ask for fewer modes"
/// @note   Collective on `comm`.
/// @throws chladni::Error on all ranks when a machine has less.
void require_memory(double own_MiB, const std::string& what, const std::string& cure,
                    MPI_Comm comm);

}  // namespace chladni::linear
