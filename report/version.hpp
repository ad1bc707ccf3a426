#pragma once

#include <string_view>

namespace chladni::report {

/// Of Chladni, "major.minor.patch".
inline constexpr std::string_view version = CHLADNI_VERSION;

}  // namespace chladni::report
