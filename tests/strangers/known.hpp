#pragma once

#include <string>

namespace chladni::strangers {

/// What round-off decides of a pencil by one way of solving on so many ranks, in words; empty: all
/// must hold.
std::string known_wrong(const std::string& pencil, const std::string& way, int ranks);

}  // namespace chladni::strangers
