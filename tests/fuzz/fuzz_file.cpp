#include "fuzz_file.hpp"

#include <cstring>
#include <map>
#include <stdexcept>

#include "common/error.hpp"
#include "common/files/seal.hpp"
#include "damage.hpp"
#include "memory_file.hpp"

/// Read by the address sanitizer before main. libhdf5 believes a damaged file that its metadata
/// fill a terabyte, asks malloc for it, and gives up when there is none: that is its right. Our own
/// code ends the program when it asks `new` for more than this.
extern "C" const char* __asan_default_options()  // NOLINT: the name is the sanitizer's
{
  return "allocator_may_return_null=1:max_allocation_size_mb=64";
}

namespace chladni::fuzz {
namespace {

/// A golden file behind an empty user block.
const std::string& with_room_for_a_seal(const std::string& golden)
{
  static std::map<std::string, std::string> files;
  const auto [file, is_new] = files.try_emplace(golden);
  if (is_new) file->second = std::string(files::seal_size, '\0') + bytes_of(golden);
  return file->second;
}

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
  const std::string& whole = with_room_for_a_seal(golden);
  if (bytes.size() > 8 && std::memcmp(bytes.data(), whole.data() + files::seal_size, 8) == 0) {
    const MemoryFile file(bytes);
    read_or_refuse(file.path(), read);
    return;
  }
  const MemoryFile file({reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()});
  damage(file.path(), bytes);
  if (!files::write_seal(file.path())) throw std::runtime_error("the damaged file has no seal");
  read_or_refuse(file.path(), read);
}

}  // namespace chladni::fuzz
