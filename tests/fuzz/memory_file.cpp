#include "memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace chladni::fuzz {

MemoryFile::MemoryFile(std::span<const std::uint8_t> bytes)
    : descriptor_(memfd_create("fuzz", MFD_CLOEXEC))
{
  if (descriptor_ < 0 || write(descriptor_, bytes.data(), bytes.size()) != ssize_t(bytes.size()))
    std::abort();
}

MemoryFile::~MemoryFile()
{
  close(descriptor_);
}

std::string MemoryFile::path() const
{
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

std::string bytes_of(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace chladni::fuzz
