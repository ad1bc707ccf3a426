#pragma once

#include <string>
#include <utility>

#include "common/error.hpp"

namespace chladni::mbs_export::formats {

/// What a format of another program cannot hold; knows which key of the scene asks for it.
class ExportError : public Error {
 public:
  /// @param key  "body.fixed"; of the tables of a list "spring.damping", without saying of which
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
