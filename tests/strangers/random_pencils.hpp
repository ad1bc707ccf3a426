#pragma once

#include <cstdint>
#include <string>

#include "checks.hpp"

namespace chladni::strangers {

/// A pencil and a way to reduce it, both drawn at random; the same for the same seed on any
/// machine.
struct Draw {
  Pencil pencil;
  Reference exact;
  Reduction how;
  std::string words;  ///< the kinds that were drawn, sizes, method
};
Draw draw(std::uint64_t seed);

}  // namespace chladni::strangers
