#pragma once

#include <cstdint>

namespace chladni::confinement {

/// The resources that a process may take in addition to those it has.
struct Limits {
  std::uint64_t memory;  ///< bytes of address space
  double seconds;        ///< s of CPU time
};

/// Exit code of a confined process that ran out of memory, or that crashed with more than half of
/// its memory in use.
inline constexpr int exit_out_of_memory = 111;

/// Exit code of a confined process on an errand whose caller no longer waits.
inline constexpr int exit_left_alone = 112;

/// Lets this process on an errand end with the process that started it, now if that has ended.
void end_with_caller();

/// Confines this process permanently: it can read, compute, and write its result to files that are
/// already open (see `filter_system_calls`). A kernel with Landlock also forbids, by another
/// mechanism, all changes of files. The process ends with the process that started it.
/// @throws chladni::Error as `filter_system_calls`.
void confine(const Limits& limits);

}  // namespace chladni::confinement
