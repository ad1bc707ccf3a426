#pragma once

#include <string>

namespace chladni::files {

/// XXH64 of a file's bytes, hexadecimal: it finds changes, not forgery.
/// @return empty when the file cannot be read
std::string file_digest(const std::string& path);

}  // namespace chladni::files
