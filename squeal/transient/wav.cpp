#include "squeal/transient/wav.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include "common/error.hpp"

namespace chladni::squeal {

namespace {

constexpr std::uint64_t most_of_32_bits = std::numeric_limits<std::uint32_t>::max();

/// Appends the `n` low bytes of x, least significant first.
void append(std::string& bytes, std::uint64_t x, int n)
{
  for (int i = 0; i < n; ++i) bytes.push_back(static_cast<char>((x >> (8 * i)) & 0xFFU));
}

/// Name and size; a size that is in `ds64` is full here.
std::string chunk_head(const std::string& name, std::uint64_t size)
{
  std::string bytes = name;
  append(bytes, std::min(size, most_of_32_bits), 4);
  return bytes;
}

std::string chunk(const std::string& name, std::string content)
{
  const std::string head = chunk_head(name, content.size());
  if (content.size() % 2 == 1) content.push_back('\0');
  return head + content;
}

std::string format_chunk(int rate_Hz)
{
  const auto rate = static_cast<std::uint32_t>(rate_Hz);
  std::string bytes;
  append(bytes, 1, 2);         // PCM
  append(bytes, 1, 2);         // mono
  append(bytes, rate, 4);      // samples per second
  append(bytes, 2 * rate, 4);  // bytes per second
  append(bytes, 2, 2);         // bytes per sample
  append(bytes, 16, 2);        // bits per sample
  return chunk("fmt ", bytes);
}

/// Of a file whose sizes do not fit into 32 bits.
std::string sizes_chunk(std::uint64_t size, std::uint64_t n_samples)
{
  std::string bytes;
  append(bytes, size, 8);           // of what follows "RF64" and its size
  append(bytes, 2 * n_samples, 8);  // of the samples
  append(bytes, n_samples, 8);
  append(bytes, 0, 4);  // no other chunk is as large
  return chunk("ds64", bytes);
}

double scale_of(double full_scale)
{
  return full_scale > 0.0 ? full_scale : 1.0;
}

}  // namespace

std::string wav_header(const WavFormat& format)
{
  std::string comment =
      fmt::format("full scale = {:.9g} {}", scale_of(format.full_scale), format.unit);
  comment.push_back('\0');
  const auto n = static_cast<std::uint64_t>(format.n_samples);
  const std::string parts =
      format_chunk(format.rate_Hz) + chunk("LIST", "INFO" + chunk("ICMT", comment));
  const std::string data = chunk_head("data", 2 * n);
  const std::uint64_t size = 4 + parts.size() + data.size() + 2 * n;
  if (size <= most_of_32_bits) return chunk_head("RIFF", size) + "WAVE" + parts + data;
  const std::uint64_t large = size + sizes_chunk(0, 0).size();
  return chunk_head("RF64", most_of_32_bits) + "WAVE" + sizes_chunk(large, n) + parts +
         chunk_head("data", most_of_32_bits);
}

WavWriter::WavWriter(const std::filesystem::path& path, const WavFormat& format)
    : file_(path.string()), scale_(scale_of(format.full_scale))
{
  file_.write(wav_header(format));
}

void WavWriter::write(std::span<const float> x)
{
  std::string samples;
  samples.reserve(2 * x.size());
  for (const float value : x) {
    const auto level = static_cast<std::int16_t>(std::lround(32767.0 * double(value) / scale_));
    append(samples, static_cast<std::uint16_t>(level), 2);
  }
  file_.write(samples);
}

double WavWriter::commit()
{
  file_.commit();
  return scale_;
}

double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit)
{
  double largest = 0.0;
  for (const float value : x) largest = std::max(largest, std::abs(double(value)));
  WavWriter file(path, {std::ssize(x), rate_Hz, largest, unit});
  file.write(x);
  return file.commit();
}

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
