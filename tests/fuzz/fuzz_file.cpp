#include "fuzz_file.hpp"

#include <cstring>

#include "common/error.hpp"
#include "damage.hpp"
#include "memory_file.hpp"

namespace chladni::fuzz {
namespace {

void read_or_refuse(const std::string& path,
                    const std::function<void(const std::string& path)>& read)
{
  try {
    read(path);
  } catch (const Error&) {
  }
}

}  // namespace

void feed(std::span<const std::uint8_t> bytes, const std::string& golden,
          const std::function<void(const std::string& path)>& read)
{
  static const std::string whole = bytes_of(golden);
  if (bytes.size() > 8 && std::memcmp(bytes.data(), whole.data(), 8) == 0) {
    const MemoryFile file(bytes);
    read_or_refuse(file.path(), read);
    return;
  }
  const MemoryFile file({reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()});
  damage(file.path(), bytes);
  read_or_refuse(file.path(), read);
}

}  // namespace chladni::fuzz
