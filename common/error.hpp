#pragma once

#include <stdexcept>

namespace chladni {

/// The one exception of Chladni: the world is wrong (a file, an input, a singular matrix).
/// Its text says what is wrong, which value, and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace chladni
