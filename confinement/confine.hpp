#pragma once

#include <cstdint>

namespace chladni::confinement {

/// What a process may take besides what it has.
struct Limits {
  std::uint64_t memory;  ///< bytes of addresses
  double seconds;        ///< of CPU time
};

/// Exit code of a process that `confine` ended because memory ran out, or that crashed with more
/// than half of its memory in use.
inline constexpr int exit_out_of_memory = 111;

/// Exit code of a process on an errand that `confine` ended because nobody waits for it.
inline constexpr int exit_left_alone = 112;

/// From here on, and for good, this process can read and compute, and hand back what it found
/// through files that are open; see filter_system_calls. A kernel with Landlock forbids besides,
/// by another mechanism, what would change a file. It ends with the process that started it.
/// @throws chladni::Error as filter_system_calls.
void confine(const Limits& limits);

}  // namespace chladni::confinement
