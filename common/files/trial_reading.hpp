#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace chladni::files {

/// Limits for the trial of a file.
struct TrialLimits {
  std::uint64_t memory;  ///< bytes beyond those of the process before
  unsigned cpu_s;        ///< s of CPU time
  /// s of wall time, longer because of slow disks
  unsigned wall_s;
};

/// The limits for a file of `file_size` bytes.
TrialLimits limits_of_trial(std::uint64_t file_size);

/// Tries an untrusted file: another process searches for parts that lead out of the file
/// (foreign_parts.hpp), then reads every attribute and dataset as Reader does. libhdf5 1.10 follows
/// damaged metadata out of its memory, or in circles until memory runs out; packed values may
/// unpack to a thousand times their size, whatever the dataset says.
/// @return the reason not to read the file, a sentence without its subject; absent if it may be
///         read. Orderly errors of libhdf5 are no reason.
/// @throws chladni::Error when no process can be started.
std::optional<std::string> refusal_of_trial(const std::string& path, const TrialLimits& limits);

}  // namespace chladni::files
