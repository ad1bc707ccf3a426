#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace chladni::scene {

/// Largest number of parts of a dotted key or of a table's name.
inline constexpr int key_parts_max = 16;

/// Parses a TOML text with limited nesting.
/// @param file  name of the file in error messages
/// @throws toml::parse_error when the text is not TOML; chladni::Error when a key has more than
///         `key_parts_max` parts, because toml++ and the readers recurse once for each part.
toml::table parse_values(std::string_view text, const std::string& file = "");

}  // namespace chladni::scene
