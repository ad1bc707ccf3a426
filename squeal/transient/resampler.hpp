#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// Converts a signal to another sampling rate while it is computed, by convolution with a windowed
/// sinc whose cut-off is below half of the lower rate, so that there is no aliasing. The signal
/// counts as zero before its begin and after its end.
class Resampler {
 public:
  /// @param step     distance of the input samples, s; the first one is at step / 2
  /// @param rate_Hz  output rate; the first output sample is at t = 0
  Resampler(double step, int rate_Hz);

  void add(double x);

  /// The output samples that have become complete since the last call; after `finish` all others.
  std::vector<float> take() { return std::exchange(out_, {}); }
  /// Number of complete output samples that were not taken yet.
  std::size_t n_waiting() const { return out_.size(); }
  /// Ends the signal.
  void finish();

  /// Archives the state, without the output samples that were not taken.
  void exchange(StateArchive& archive) { archive(in_, n_in_, n_out_); }

 private:
  double kernel(double time) const;
  void emit();

  double step_;
  double rate_Hz_;
  double half_width_;          ///< half width of the kernel, s
  std::vector<double> table_;  ///< kernel values over 0 ... half_width_
  std::vector<double> in_;     ///< ring buffer of the latest samples
  std::int64_t n_in_ = 0;
  std::int64_t n_out_ = 0;
  std::vector<float> out_;
};

}  // namespace chladni::squeal
