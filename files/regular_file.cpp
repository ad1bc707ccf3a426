#include "files/regular_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "common/error.hpp"

namespace chladni::files {
namespace {

const char* name_of(std::filesystem::file_type type)
{
  switch (type) {
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::fifo:
      return "a FIFO";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

}  // namespace

std::uint64_t regular_file_size(const std::string& path)
{
  std::error_code failure;
  const std::filesystem::file_type type = std::filesystem::status(path, failure).type();
  using std::filesystem::file_type;
  if (type == file_type::not_found || type == file_type::none || type == file_type::unknown)
    throw Error(fmt::format("{}: no such file, or not readable", path));
  if (type != file_type::regular)
    throw Error(fmt::format("{}: is {}, expected an ordinary file", path, name_of(type)));
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure) throw Error(fmt::format("{}: no such file, or not readable", path));
  return size;
}

}  // namespace chladni::files
