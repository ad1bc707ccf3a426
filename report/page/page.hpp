#pragma once

#include <string>
#include <string_view>

#include "report/json.hpp"

namespace chladni::report {

/// The page with everything that it needs inside it.
/// @param benchmark  JSON text that the page draws too, or "null"
std::string report_page(std::string_view title, const Json& content, std::string_view benchmark);

}  // namespace chladni::report
