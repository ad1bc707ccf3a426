#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::mbs_export {

inline constexpr auto response_format = "chladni-response";

/// Writes `*.response.h5` under a temporary name and renames it.
/// @throws chladni::Error when the file cannot be written.
void write_responses(const std::filesystem::path& path, const FrequencyResponses& responses);

/// Reads a file of frequency responses.
/// @throws chladni::Error naming file and dataset for what is missing, of the wrong kind, or
///         contradictory.
FrequencyResponses read_responses(const std::filesystem::path& path);
FrequencyResponses read_responses(const files::Reader& file);

}  // namespace chladni::mbs_export
