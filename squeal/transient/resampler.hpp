#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// Samples of a signal at another rate while it is computed: convolution with a windowed sinc that
/// cuts off below half of the lower rate, so that nothing is folded down. The signal counts as zero
/// before it begins and after it ends.
class Resampler {
 public:
  /// @param step     of the samples that come in, s; the first one is at step / 2
  /// @param rate_Hz  of those that go out, the first one at 0
  Resampler(double step, int rate_Hz);

  void add(double x);

  /// The samples that have become complete since the last call; after `finish`, the rest.
  std::vector<float> take() { return std::exchange(out_, {}); }
  std::size_t n_waiting() const { return out_.size(); }
  void finish();

  /// What was not taken is no part of the state.
  void exchange(StateArchive& archive) { archive(in_, n_in_, n_out_); }

 private:
  double kernel(double time) const;
  void emit();

  double step_;
  double rate_Hz_;
  double half_width_;          ///< of the kernel, s
  std::vector<double> table_;  ///< the kernel over 0 ... half_width_
  std::vector<double> in_;     ///< ring of the latest samples
  std::int64_t n_in_ = 0;
  std::int64_t n_out_ = 0;
  std::vector<float> out_;
};

}  // namespace chladni::squeal
