#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "files/replacement.hpp"

namespace chladni::squeal {

/// Header data of a mono WAV file with 16 bits.
struct WavFormat {
  std::int64_t n_samples;
  int rate_Hz;
  double full_scale;         ///< largest |x|; 0 for silence
  std::string unit = "m/s";  ///< unit of `full_scale`
};

/// The header of the file, all bytes before the samples. A file above 4 GiB becomes an RF64 file:
/// its sizes are in a chunk `ds64`, and the 32-bit sizes have their maximum. The value of full
/// scale is in a comment (chunk LIST, INFO, ICMT): "full scale = 6.73 m/s".
/// Source: EBU Tech 3306, MBWF / RF64 (2009).
std::string wav_header(const WavFormat& format);

/// Writes a WAV file piece by piece; an existing file is replaced only by `commit`.
class WavWriter {
 public:
  /// Opens the file.
  /// @throws chladni::Error when the file cannot be written.
  WavWriter(const std::filesystem::path& path, const WavFormat& format);

  /// Appends samples.
  void write(std::span<const float> x);
  /// Completes the file.
  /// @return full scale; 1 for silence
  double commit();

 private:
  files::Replacement file_;
  double scale_;
};

/// Writes a WAV file whose largest sample is full scale.
/// @return full scale, the largest |x|; 1 for silence
/// @throws chladni::Error when the file cannot be written; an existing file then remains.
double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit = "m/s");

}  // namespace chladni::squeal
