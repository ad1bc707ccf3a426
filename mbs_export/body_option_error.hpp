#pragma once

#include <string>

#include "common/error.hpp"

namespace chladni::mbs_export {

/// Thrown when a reduced system cannot do what the scene's table [body] asks for; names the key.
class BodyOptionError : public Error {
 public:
  /// @param key  "keep.modes"
  BodyOptionError(std::string key, std::string why)
      : Error(key + ": " + why), key_(std::move(key)), why_(std::move(why))
  {}

  const std::string& key() const { return key_; }
  const std::string& why() const { return why_; }

 private:
  std::string key_;
  std::string why_;
};

}  // namespace chladni::mbs_export
