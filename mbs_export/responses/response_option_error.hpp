#pragma once

#include <string>
#include <utility>

#include "common/error.hpp"

namespace chladni::mbs_export {

/// Thrown when a model cannot answer what the scene's table [response] asks for; names the key.
class ResponseOptionError : public Error {
 public:
  /// @param key  "loads[2].at"
  ResponseOptionError(std::string key, std::string why)
      : Error("response." + key + ": " + why), key_(std::move(key)), why_(std::move(why))
  {}

  const std::string& key() const { return key_; }
  const std::string& why() const { return why_; }

 private:
  std::string key_;
  std::string why_;
};

}  // namespace chladni::mbs_export
