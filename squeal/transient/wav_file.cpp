#include "squeal/transient/wav_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace chladni::squeal
