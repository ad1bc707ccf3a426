#pragma once

#include <string>
#include <utility>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {

/// Thrown when a format of another program cannot hold something; names the key of the scene that
/// asks for it.
class ExportError : public Error {
 public:
  /// @param key  "body.fixed"; for the tables of a list "spring.damping", without an index
  ExportError(std::string key, std::string why)
      : Error(why), key_(std::move(key)), why_(std::move(why))
  {}

  const std::string& key() const { return key_; }
  const std::string& why() const { return why_; }

 private:
  std::string key_;
  std::string why_;
};

}  // namespace chladni::mbs_export::formats
