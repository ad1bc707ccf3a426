#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/files/output_file.hpp"

namespace chladni::squeal {

/// Header data of a mono WAV file with 16 bits.
struct WavFormat {
  std::int64_t n_samples;
  int rate_Hz;
  double full_scale;         ///< largest |x|; 0 for silence
  std::string unit = "m/s";  ///< unit of `full_scale`
};

/// Most samples of a file, whose sizes have 32 bits, less room for the header.
inline constexpr std::int64_t wav_samples_max = ((std::int64_t{1} << 32) - 1024) / 2;

/// The header of the file, all bytes before the samples. The value of full scale is in a comment
/// (chunk LIST, INFO, ICMT): "full scale = 6.73 m/s".
/// @throws chladni::Error for more than `wav_samples_max` samples.
std::string wav_header(const WavFormat& format);

/// Writes a WAV file whose largest sample is full scale.
/// @return full scale, the largest |x|; 1 for silence
/// @throws chladni::Error when the file cannot be written; an existing file then remains.
double write_wav(const std::filesystem::path& path, std::span<const float> x, int rate_Hz,
                 const std::string& unit = "m/s");

/// Writes a sound of unknown length and loudness. The samples go to the file as they come; at the
/// end they are scaled there, because full scale is the largest of them. So a long sound needs no
/// memory. Without `finish` no file is left, and an existing one remains.
class WavRecording {
 public:
  WavRecording(std::filesystem::path file, int rate_Hz);

  int rate_Hz() const { return rate_Hz_; }  ///< of the samples

  /// Appends samples.
  /// @throws chladni::Error when the file cannot be written.
  void add(const std::vector<float>& x);

  /// Completes the WAV file.
  /// @throws chladni::Error when it cannot be written.
  void finish();
  /// Full scale, m/s; absent before `finish`.
  const std::optional<double>& full_scale() const { return full_scale_; }

 private:
  void flush();
  void scale();

  std::filesystem::path path_;
  int rate_Hz_;
  std::optional<files::Replacement> file_;  ///< from the first samples on
  std::vector<float> waiting_;
  std::int64_t n_ = 0;
  double largest_ = 0.0;
  std::optional<double> full_scale_;
};

}  // namespace chladni::squeal
