#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chladni::scene {

/// Whether the list contains the name.
bool contains(const std::vector<std::string>& names, std::string_view name);

/// The names as `"a", "b", "c"` for messages; `(none)` for an empty list.
std::string quoted_list(const std::vector<std::string>& names);

/// The most similar name that differs by at most two letters (by one in a word of three).
/// @return empty when there is none
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// Why an unknown name of this kind is refused: `no such ring in the scene; did you mean "track"?
/// there are: "track", "rim"`.
std::string no_such_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& names);

}  // namespace chladni::scene
