#pragma once

#include <string_view>

namespace chladni::report {

/// The version of Chladni, "major.minor.patch".
inline constexpr std::string_view version = CHLADNI_VERSION;

}  // namespace chladni::report
