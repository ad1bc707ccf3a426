#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chladni::scene {

bool contains(const std::vector<std::string>& names, std::string_view name);

/// `"a", "b", "c"`, for messages; `(none)` when there are no names.
std::string quoted_list(const std::vector<std::string>& names);

/// The name that differs least from `name`, by at most two letters (one in a word of three).
/// @return empty when there is none.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// `no such ring in the scene; did you mean "track"? there are: "track", "rim"`, why a name that
/// refers to something of this kind is refused.
std::string no_such_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string>& names);

}  // namespace chladni::scene
