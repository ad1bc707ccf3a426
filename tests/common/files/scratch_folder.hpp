#pragma once

#include <filesystem>
#include <string>

#include "common/error.hpp"

namespace chladni::files::test {

/// A folder of its own for the running test, empty at first and removed at the end.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// All bytes of a file.
std::string bytes_of(const std::string& path);

/// The text of the chladni::Error that `statement` throws; empty when it throws nothing.
template <class Statement>
std::string error_of(Statement statement)
{
  try {
    statement();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace chladni::files::test
