#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace chladni::scene {

/// Parts of a dotted key, and of the name of a table.
inline constexpr int key_parts_max = 16;

/// The values of a text in TOML, which are nested no deeper than a stack can follow.
/// @param file  what errors call it
/// @throws toml::parse_error when the text is no TOML, and chladni::Error when a key has more than
///         `key_parts_max` parts: toml++ and whoever walks through its tables call themselves once
///         for each of them.
toml::table parse_values(std::string_view text, const std::string& file = "");

}  // namespace chladni::scene
