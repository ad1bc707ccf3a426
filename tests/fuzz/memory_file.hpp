#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace chladni::fuzz {

/// A file in memory, with a path that others can open while this lives.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// All bytes of a file of the project.
std::string bytes_of(const std::string& path);

}  // namespace chladni::fuzz
