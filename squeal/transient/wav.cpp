#include "squeal/transient/wav.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <span>
#include <utility>

#include "common/error.hpp"

namespace chladni::squeal {

namespace {

/// Appends the `n` low bytes of x, least significant first.
void append_number(std::string& bytes, std::uint64_t x, int n)
{
  for (int i = 0; i < n; ++i) bytes.push_back(static_cast<char>((x >> (8 * i)) & 0xFFU));
}

std::string chunk_head(const std::string& name, std::uint64_t size)
{
  std::string bytes = name;
  append_number(bytes, size, 4);
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
  append_number(bytes, 1, 2);         // PCM
  append_number(bytes, 1, 2);         // mono
  append_number(bytes, rate, 4);      // samples per second
  append_number(bytes, 2 * rate, 4);  // bytes per second
  append_number(bytes, 2, 2);         // bytes per sample
  append_number(bytes, 16, 2);        // bits per sample
  return chunk("fmt ", bytes);
}

double scale_of_samples(double full_scale)
{
  return full_scale > 0.0 ? full_scale : 1.0;
}

}  // namespace

std::string wav_header(const WavFormat& format)
{
  if (format.n_samples > wav_samples_max) {
    throw Error(
        fmt::format("a WAV file holds up to 4 GiB, {:.0f} s at {} Hz, and the sound has {:.0f} s",
                    double(wav_samples_max) / format.rate_Hz, format.rate_Hz,
                    double(format.n_samples) / format.rate_Hz));
  }
  std::string comment =
      fmt::format("full scale = {:.9g} {}", scale_of_samples(format.full_scale), format.unit);
  comment.push_back('\0');
  const auto n = static_cast<std::uint64_t>(format.n_samples);
  const std::string parts =
      format_chunk(format.rate_Hz) + chunk("LIST", "INFO" + chunk("ICMT", comment));
  const std::string data = chunk_head("data", 2 * n);
  return chunk_head("RIFF", 4 + parts.size() + data.size() + 2 * n) + "WAVE" + parts + data;
}

namespace {

/// The samples with 16 bits.
std::string levels(std::span<const float> x, double full_scale)
{
  std::string bytes;
  bytes.reserve(2 * x.size());
  for (const float value : x) {
    const auto level = static_cast<std::int16_t>(
        std::lround(32767.0 * double(value) / scale_of_samples(full_scale)));
    append_number(bytes, static_cast<std::uint16_t>(level), 2);
  }
  return bytes;
}

/// Samples that are written, and read again, at a time.
constexpr std::size_t samples_at_a_time = 1U << 16U;
/// Where samples wait for their scale; no header is longer.
constexpr std::size_t waiting_from = 256;

}  // namespace

double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit)
{
  double largest = 0.0;
  for (const float value : x) largest = std::max(largest, std::abs(double(value)));
  files::Replacement file(path.string());
  file.write(wav_header({std::ssize(x), rate_Hz, largest, unit}));
  for (; !x.empty(); x = x.subspan(std::min(samples_at_a_time, x.size())))
    file.write(levels(x.first(std::min(samples_at_a_time, x.size())), largest));
  file.commit();
  return scale_of_samples(largest);
}

WavRecording::WavRecording(std::filesystem::path file, int rate_Hz)
    : path_(std::move(file)), rate_Hz_(rate_Hz)
{}

void WavRecording::add(const std::vector<float>& x)
{
  for (const float value : x) largest_ = std::max(largest_, std::abs(double(value)));
  waiting_.insert(waiting_.end(), x.begin(), x.end());
  n_ += std::ssize(x);
  if (waiting_.size() >= samples_at_a_time) flush();
}

void WavRecording::flush()
{
  if (!file_) {
    if (files::is_stream(path_)) {
      throw Error(
          fmt::format("{}: is no ordinary file, and the sound is scaled in it", path_.string()));
    }
    file_.emplace(path_.string());
    file_->write(std::string(waiting_from, '\0'));
  }
  const std::span<const std::byte> bytes = std::as_bytes(std::span(waiting_));
  file_->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  waiting_.clear();
}

/// Samples of 16 bits take half the room, so that writing them never reaches those to be read.
void WavRecording::scale()
{
  std::fstream file(file_->temporary(), std::ios::binary | std::ios::in | std::ios::out);
  std::string bytes = wav_header({.n_samples = n_, .rate_Hz = rate_Hz_, .full_scale = largest_});
  std::size_t begin = 0;
  std::vector<float> x;
  for (std::size_t read = 0; read < std::size_t(n_); read += x.size()) {
    x.resize(std::min(samples_at_a_time, std::size_t(n_) - read));
    file.seekg(std::streamoff(waiting_from + read * sizeof(float)));
    file.read(reinterpret_cast<char*>(x.data()), std::streamsize(x.size() * sizeof(float)));
    bytes += levels(x, largest_);
    file.seekp(std::streamoff(begin)).write(bytes.data(), std::streamsize(bytes.size()));
    begin += bytes.size();
    bytes.clear();
  }
  file.seekp(std::streamoff(begin)).write(bytes.data(), std::streamsize(bytes.size()));
  if (!file.flush()) file_->fail();
  file.close();
  std::filesystem::resize_file(file_->temporary(), begin + bytes.size());
}

void WavRecording::finish()
{
  flush();
  scale();
  file_->commit();
  file_.reset();
  full_scale_ = scale_of_samples(largest_);
}

}  // namespace chladni::squeal
