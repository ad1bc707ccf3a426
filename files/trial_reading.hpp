#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace chladni::files {

/// What the trial of a file may take.
struct TrialLimits {
  std::uint64_t memory;  ///< beyond what the process held before, bytes
  unsigned cpu_s;        ///< of the processor
  unsigned wall_s;       ///< on the clock: a slow disk needs longer than libhdf5
};

/// Limits that befit a file of so many bytes.
TrialLimits limits_of_trial(std::uint64_t file_size);

/// Tries a file that nobody vouches for: a process of its own looks for what leads out of the file
/// (foreign_parts.hpp), then reads every attribute and dataset as Reader does. libhdf5 1.10 follows
/// damaged metadata out of its memory, or in circles until no memory is left; packed values may
/// unpack to a thousand times their size, whatever the dataset says.
/// @return why the file is not to be read, a sentence without its subject; nothing where it may be.
///         What libhdf5 refuses in order is no matter here.
/// @throws chladni::Error when no process can be started.
std::optional<std::string> refusal_of_trial(const std::string& path, const TrialLimits& limits);

}  // namespace chladni::files
