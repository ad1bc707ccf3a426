#pragma once

#include <string>

namespace chladni::files {

/// The XXH64 digest of a file's bytes, in hexadecimal. It detects changes, but no forgery.
/// @return empty if the file cannot be read
std::string file_digest(const std::string& path);

}  // namespace chladni::files
