#pragma once

#include <string>
#include <string_view>

namespace chladni::files {

/// Writes `text` completely or not at all (replacement.hpp).
/// @throws chladni::Error when the file cannot be written; an older file is left as it was.
void write_text(const std::string& path, std::string_view text);

}  // namespace chladni::files
