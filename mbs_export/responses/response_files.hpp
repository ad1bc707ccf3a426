#pragma once

#include <filesystem>
#include <string>

#include "common/files/hdf5.hpp"
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

/// A table (RFC 4180) with a row for each frequency in Hz and two columns for each output and load,
/// real and imaginary part, with those of measured responses behind the computed ones. The headings
/// name both and the unit: "tip.z / hub.z re, m/N", "tip.z / hub.z measured (line 12) re, m/N" with
/// the line of the measurement's file. Numbers have all their digits.
std::string csv_of(const FrequencyResponses& responses);

/// Frequency responses as a universal file in ASCII: units (dataset 164, SI), the nodes of loads
/// and outputs (2411), and a function of type 4 for each output and load (58), complex and in
/// double precision. The format gives frequencies six digits.
/// @throws chladni::Error for a load that several nodes share, which the format cannot name.
/// Source: SDRC, Universal Dataset Numbers 58, 164 and 2411.
std::string universal_file_of(const FrequencyResponses& responses);

}  // namespace chladni::mbs_export
