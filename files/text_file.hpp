#pragma once

#include <string>
#include <string_view>

namespace chladni::files {

/// Writes `text` as a whole or not at all (replacement.hpp).
/// @throws chladni::Error when the file cannot be written; an older one is then left as it was.
void write_text(const std::string& path, std::string_view text);

}  // namespace chladni::files
