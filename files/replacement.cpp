#include "files/replacement.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/error.hpp"

namespace chladni::files {
namespace {

/// On disk before the rename, so that a power cut cannot leave a named but empty file.
bool synchronise(const std::string& path)
{
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_done = fsync(descriptor) == 0;
  close(descriptor);
  return is_done;
}

}  // namespace

Replacement::Replacement(std::string path)
    : path_(std::move(path)), temporary_(fmt::format("{}.tmp-{}", path_, getpid()))
{}

Replacement::~Replacement()
{
  if (!is_committed_) std::remove(temporary_.c_str());
}

void Replacement::commit()
{
  if (!synchronise(temporary_) || std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  is_committed_ = true;
}

void Replacement::fail() const
{
  throw Error(fmt::format("{}: cannot be completed ({}); an older file is left as it was", path_,
                          std::strerror(errno)));
}

}  // namespace chladni::files
