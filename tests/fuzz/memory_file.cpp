#include "memory_file.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace chladni::fuzz {

// Not memfd_create: HDF5 resolves links, and what they lead to under /proc has no name.
MemoryFile::MemoryFile(std::span<const std::uint8_t> bytes) : path_("/dev/shm/fuzz-XXXXXX")
{
  const int descriptor = mkstemp(path_.data());
  if (descriptor < 0 || write(descriptor, bytes.data(), bytes.size()) != ssize_t(bytes.size()))
    std::abort();
  close(descriptor);
}

MemoryFile::~MemoryFile()
{
  unlink(path_.c_str());
}

std::string bytes_of(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace chladni::fuzz
