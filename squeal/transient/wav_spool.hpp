#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/unfinished_file.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

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
