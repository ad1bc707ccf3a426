#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/files/output_file.hpp"
#include "squeal/motion/state_archive.hpp"

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

/// Collects the samples of a sound in a file of their own until the WAV file is written, because
/// full scale is the largest sample, which is known only at the end. So a long sound needs no
/// memory.
class WavSpool {
 public:
  /// @param wav    the WAV file
  /// @param spool  file for the samples, used by nobody else; a symbolic link is not followed
  WavSpool(std::filesystem::path wav, std::filesystem::path spool, int rate_Hz);
  ~WavSpool();
  WavSpool(const WavSpool&) = delete;
  WavSpool& operator=(const WavSpool&) = delete;

  int rate_Hz() const { return rate_Hz_; }  ///< of the samples

  /// Appends samples.
  /// @throws chladni::Error when the file cannot be written.
  void add(const std::vector<float>& x);

  /// Writes the WAV file.
  /// @throws chladni::Error when it cannot be written.
  void finish();
  /// Full scale, m/s; absent before `finish`.
  const std::optional<double>& full_scale() const { return full_scale_; }

  /// Archives the position in the samples; from then on their file outlives the process.
  /// @throws chladni::Error when a restored state's file of samples is missing or too short.
  void exchange(StateArchive& archive);

  /// Removes the file of the samples.
  void remove();

 private:
  void open_new();
  void open_with(std::int64_t n);
  void flush();
  [[noreturn]] void fail() const;

  std::filesystem::path wav_, spool_;
  int rate_Hz_;
  int descriptor_ = -1;  ///< file descriptor; negative before the first sample
  std::optional<files::UnfinishedFile> unfinished_;
  std::vector<float> waiting_;
  std::int64_t n_ = 0;
  double largest_ = 0.0;
  std::optional<double> full_scale_;
};

}  // namespace chladni::squeal
