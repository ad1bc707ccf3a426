#include "squeal/wav_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "files/replacement.hpp"

namespace chladni::squeal {
namespace {

/// Appends the `n` low bytes of x, least significant first.
void append(std::string& bytes, std::uint32_t x, int n)
{
  for (int i = 0; i < n; ++i) bytes.push_back(static_cast<char>((x >> (8 * i)) & 0xFFU));
}

std::string chunk(const std::string& name, std::string content)
{
  std::string bytes = name;
  append(bytes, static_cast<std::uint32_t>(content.size()), 4);
  if (content.size() % 2 == 1) content.push_back('\0');
  return bytes + content;
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

}  // namespace

double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit)
{
  double scale = 0.0;
  for (const float value : x) scale = std::max(scale, std::abs(double(value)));
  if (!(scale > 0.0)) scale = 1.0;
  std::string samples;
  for (const float value : x) {
    const auto level = static_cast<std::int16_t>(std::lround(32767.0 * double(value) / scale));
    append(samples, static_cast<std::uint16_t>(level), 2);
  }
  std::string comment = fmt::format("full scale = {:.9g} {}", scale, unit);
  comment.push_back('\0');
  const std::string content = "WAVE" + format_chunk(rate_Hz) +
                              chunk("LIST", "INFO" + chunk("ICMT", comment)) +
                              chunk("data", samples);
  files::Replacement file(path.string());
  file.write(chunk("RIFF", content));
  file.commit();
  return scale;
}

}  // namespace chladni::squeal
