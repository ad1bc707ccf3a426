#pragma once

#include <string>

namespace chladni::strangers {

/// What is known not to hold of a pencil by one way of solving on so many ranks. No other property
/// may fail.
struct KnownWrong {
  std::string properties;  ///< words; empty: all must hold
  bool sometimes;          ///< round-off decides whether one fails
};
KnownWrong known_wrong(const std::string& pencil, const std::string& way, int ranks);

}  // namespace chladni::strangers
