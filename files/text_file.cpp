#include "files/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/error.hpp"

namespace chladni::files {
namespace {

bool write_all(int descriptor, std::string_view text)
{
  while (!text.empty()) {
    const ssize_t n = ::write(descriptor, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  return ::fsync(descriptor) == 0;
}

bool write_file(const std::string& path, std::string_view text)
{
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  const bool written = write_all(descriptor, text);
  return ::close(descriptor) == 0 && written;
}

}  // namespace

void write_text(const std::string& path, std::string_view text)
{
  const std::string temporary = fmt::format("{}.tmp-{}", path, ::getpid());
  if (write_file(temporary, text) && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const std::string reason = std::strerror(errno);
  std::remove(temporary.c_str());
  throw Error(fmt::format("{}: cannot be written: {}", path, reason));
}

}  // namespace chladni::files
