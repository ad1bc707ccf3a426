#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files/unfinished_file.hpp"
#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// The samples of a sound on their way to a WAV file. They go to a file of their own as they come,
/// since the largest of them, which is full scale, is known at the end alone; so a long sound takes
/// no memory.
class WavSpool {
 public:
  /// @param spool  file for the samples, which nobody else uses meanwhile; a link is not followed
  WavSpool(std::filesystem::path wav, std::filesystem::path spool, int rate_Hz);
  ~WavSpool();
  WavSpool(const WavSpool&) = delete;
  WavSpool& operator=(const WavSpool&) = delete;

  int rate_Hz() const { return rate_Hz_; }  ///< of the samples

  /// @throws chladni::Error when the file cannot be written.
  void add(const std::vector<float>& x);

  /// Writes the WAV file.
  void finish();
  /// Full scale, m/s, when that was done.
  const std::optional<double>& full_scale() const { return full_scale_; }

  /// The samples so far belong to the state of a run: from here on the file outlives the process.
  /// @throws chladni::Error where the file of a state that is given back is missing or shorter.
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
  int descriptor_ = -1;  ///< negative before the first sample
  std::optional<files::UnfinishedFile> unfinished_;
  std::vector<float> waiting_;
  std::int64_t n_ = 0;
  double largest_ = 0.0;
  std::optional<double> full_scale_;
};

}  // namespace chladni::squeal
