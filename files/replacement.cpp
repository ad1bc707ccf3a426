#include "files/replacement.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "common/error.hpp"

namespace chladni::files {
namespace {

/// The new name on disk, so that a power cut cannot bring the old file back. Folders that cannot be
/// flushed are the file system's business.
void synchronise_folder_of(const std::string& path)
{
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool is_broken = fsync(descriptor) != 0 && errno == EIO;
  close(descriptor);
  if (is_broken) {
    throw Error(fmt::format("{}: is written, but its folder cannot be flushed to disk ({})", path,
                            std::strerror(EIO)));
  }
}

}  // namespace

std::string older_file_stays(const std::string& path)
{
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? "; the older file is left as it was" : "";
}

Replacement::Replacement(std::string path)
    : path_(std::move(path)),
      lock_(files::lock_output(path_)),
      temporary_(lock_ ? files::temporary_name(path_) : path_)
{
  if (lock_) unfinished_.emplace(temporary_);
  const int creation = lock_ ? O_CREAT | O_EXCL | O_NOFOLLOW : O_APPEND;
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CLOEXEC | creation, 0666);
  if (descriptor_ < 0) fail();
}

Replacement::~Replacement()
{
  if (unfinished_) std::remove(temporary_.c_str());
  close(descriptor_);
}

void Replacement::write(std::string_view bytes)
{
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void Replacement::commit()
{
  if (!lock_) return;
  if (fsync(descriptor_) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  unfinished_.reset();
  synchronise_folder_of(path_);
}

void Replacement::fail() const
{
  throw Error(fmt::format("{}: cannot be completed ({}){}", path_, std::strerror(errno),
                          lock_ ? older_file_stays(path_) : ""));
}

}  // namespace chladni::files
