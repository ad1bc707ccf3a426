#pragma once

#include <string_view>

namespace chladni::cli {

/// Of Chladni, "major.minor.patch".
inline constexpr std::string_view version = CHLADNI_VERSION;

}  // namespace chladni::cli
