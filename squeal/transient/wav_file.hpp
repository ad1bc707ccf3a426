#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "files/replacement.hpp"

namespace chladni::squeal {

/// What stands before the samples of a mono WAV file of 16 bits.
struct WavFormat {
  std::int64_t n_samples;
  int rate_Hz;
  double full_scale;         ///< the largest |x|; 0 for silence
  std::string unit = "m/s";  ///< of `full_scale`
};

/// All bytes before the samples. A file beyond 4 GiB is an RF64 file: its sizes stand in a chunk
/// `ds64`, and those of 32 bits are full. What full scale means stands in a comment (chunk LIST,
/// INFO, ICMT): "full scale = 6.73 m/s".
/// Source: EBU Tech 3306, MBWF / RF64 (2009).
std::string wav_header(const WavFormat& format);

/// Writes a WAV file piece by piece; an old one is left as it was until all is there.
class WavWriter {
 public:
  /// @throws chladni::Error when the file cannot be written.
  WavWriter(const std::filesystem::path& path, const WavFormat& format);

  void write(std::span<const float> x);
  /// @return full scale; 1 for silence
  double commit();

 private:
  files::Replacement file_;
  double scale_;
};

/// A whole WAV file, the largest sample of which is full scale.
/// @return full scale, the largest |x|; 1 for silence
/// @throws chladni::Error when the file cannot be written; an old one is left as it was.
double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit = "m/s");

}  // namespace chladni::squeal
