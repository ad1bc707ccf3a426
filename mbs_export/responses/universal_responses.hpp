#pragma once

#include <string>

#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::mbs_export {

/// Frequency responses as a universal file in ASCII: units (dataset 164, SI), the nodes of loads
/// and outputs (2411), and a function of type 4 for each output and load (58), complex and in
/// double precision. The format gives frequencies six digits.
/// @throws chladni::Error for a load that several nodes share, which the format cannot name.
/// Source: SDRC, Universal Dataset Numbers 58, 164 and 2411.
std::string universal_file_of(const FrequencyResponses& responses);

}  // namespace chladni::mbs_export
