#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace chladni::report {

/// Bytes as text (RFC 4648), for binary numbers inside a page.
std::string base64(std::span<const std::byte> bytes);

}  // namespace chladni::report
