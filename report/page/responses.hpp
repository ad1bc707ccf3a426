#pragma once

#include <string>

#include "mbs_export/responses/frequency_responses.hpp"

namespace chladni::report {

/// Frequency responses as a page: amplitude and phase of the outputs for each load, and tables.
/// Only the 24 largest outputs are drawn, and the page says so.
std::string responses_page(const mbs_export::FrequencyResponses& responses);

}  // namespace chladni::report
