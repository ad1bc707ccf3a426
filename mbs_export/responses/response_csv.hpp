#pragma once

#include <string>

#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::mbs_export {

/// A table (RFC 4180) with a row for each frequency in Hz and two columns for each output and load,
/// real and imaginary part, with those of measured responses behind the computed ones. The headings
/// name both and the unit: "tip.z / hub.z re, m/N", "tip.z / hub.z measured (line 12) re, m/N" with
/// the line of the measurement's file. Numbers have all their digits.
std::string csv_of(const FrequencyResponses& responses);

}  // namespace chladni::mbs_export
