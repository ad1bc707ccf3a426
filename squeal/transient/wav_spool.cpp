#include "squeal/transient/wav_spool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "common/error.hpp"
#include "squeal/transient/wav_file.hpp"

namespace chladni::squeal {
namespace {

/// Samples that are written, and read again, at a time.
constexpr std::size_t block = 1U << 16U;

}  // namespace

WavSpool::WavSpool(std::filesystem::path wav, std::filesystem::path spool, int rate_Hz)
    : wav_(std::move(wav)), spool_(std::move(spool)), rate_Hz_(rate_Hz)
{}

WavSpool::~WavSpool()
{
  if (unfinished_) unlink(spool_.c_str());
  if (descriptor_ >= 0) close(descriptor_);
}

void WavSpool::fail() const
{
  throw Error(fmt::format("{}: the samples of the sound cannot be written or read: {}",
                          spool_.string(), std::strerror(errno)));
}

void WavSpool::open_new()
{
  unlink(spool_.c_str());
  unfinished_.emplace(spool_.string());
  descriptor_ = open(spool_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail();
}

void WavSpool::open_with(std::int64_t n)
{
  descriptor_ = open(spool_.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) fail();
  const auto size = n * static_cast<std::int64_t>(sizeof(float));
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) fail();
  if (!S_ISREG(status.st_mode) || status.st_size < size) {
    throw Error(fmt::format("{}: lacks samples of the sound; start again without --resume",
                            spool_.string()));
  }
  if (ftruncate(descriptor_, size) != 0 || lseek(descriptor_, 0, SEEK_END) < 0) fail();
}

void WavSpool::add(const std::vector<float>& x)
{
  for (const float value : x) largest_ = std::max(largest_, std::abs(double(value)));
  waiting_.insert(waiting_.end(), x.begin(), x.end());
  n_ += std::ssize(x);
  if (waiting_.size() >= block) flush();
}

void WavSpool::flush()
{
  if (descriptor_ < 0) open_new();
  std::span<const std::byte> bytes = std::as_bytes(std::span(waiting_));
  while (!bytes.empty()) {
    const ssize_t n = write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  waiting_.clear();
}

void WavSpool::finish()
{
  flush();
  WavWriter file(wav_, {.n_samples = n_, .rate_Hz = rate_Hz_, .full_scale = largest_});
  std::vector<float> samples(block);
  if (lseek(descriptor_, 0, SEEK_SET) < 0) fail();
  for (std::int64_t left = n_; left > 0;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::int64_t>(left, block));
    std::span<std::byte> bytes = std::as_writable_bytes(std::span(samples).first(wanted));
    while (!bytes.empty()) {
      const ssize_t n = read(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail();
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    file.write(std::span(samples).first(wanted));
    left -= static_cast<std::int64_t>(wanted);
  }
  full_scale_ = file.commit();
}

void WavSpool::exchange(StateArchive& archive)
{
  if (!archive.gives()) flush();
  archive(n_, largest_);
  if (archive.gives()) return open_with(n_);
  if (fsync(descriptor_) != 0) fail();
  unfinished_.reset();
}

void WavSpool::remove()
{
  unlink(spool_.c_str());
}

}  // namespace chladni::squeal
