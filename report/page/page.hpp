#pragma once

#include <string>
#include <string_view>

#include "report/json.hpp"

namespace chladni::report {

/// The HTML page with everything it needs inside.
/// @param benchmark  JSON text of a benchmark to draw as well, or "null"
std::string report_page(std::string_view title, const Json& content, std::string_view benchmark);

}  // namespace chladni::report
