#pragma once

#include <cstdint>
#include <vector>

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

  /// All samples that are complete by now; after `finish`, all.
  const std::vector<float>& samples() const { return out_; }
  void finish();

 private:
  double kernel(double time) const;
  void emit();

  double step_;
  double rate_Hz_;
  double half_width_;          ///< of the kernel, s
  std::vector<double> table_;  ///< the kernel over 0 ... half_width_
  std::vector<double> in_;     ///< ring of the latest samples
  std::int64_t n_in_ = 0;
  std::vector<float> out_;
};

}  // namespace chladni::squeal
