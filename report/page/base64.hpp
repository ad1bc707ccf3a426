#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace chladni::report {

/// Bytes as base64 text (RFC 4648), for binary numbers in a page.
std::string base64(std::span<const std::byte> bytes);

}  // namespace chladni::report
