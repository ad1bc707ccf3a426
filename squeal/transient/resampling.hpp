#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace chladni::squeal {

/// Reduces the sampling rate of several signals by `factor`, after a windowed-sinc low-pass filter
/// that prevents aliasing. Output sample j belongs to the time of input sample j * factor. Near
/// both ends the weights of the available samples are scaled to the sum one, so that a constant is
/// preserved everywhere. The memory depends on `factor` only.
class DecimatorStage {
 public:
  /// @param factor     at least 2
  /// @param n_signals  number of signals
  DecimatorStage(int factor, Eigen::Index n_signals);

  /// Adds the next sample.
  /// @param x  [n_signals]
  /// @return [n_signals] the output sample that has become complete, if any
  std::optional<Eigen::VectorXd> add(const Eigen::VectorXd& x);

  /// After the last sample: the next of the remaining output samples, whose filter extends beyond
  /// the end.
  std::optional<Eigen::VectorXd> take_rest();

 private:
  Eigen::VectorXd emit();

  int factor_;
  Eigen::Index half_;        ///< number of taps on either side of the middle one
  Eigen::VectorXd taps_;     ///< [2 half_ + 1]
  Eigen::MatrixXd samples_;  ///< [n_signals x 2 (2 half_ + 1)] latest samples, each stored twice
  std::int64_t n_in_ = 0;
  std::int64_t n_out_ = 0;
};

/// Reduction of a sampling rate in stages.
struct Decimation {
  int factor = 1;    ///< factor of each stage; 1 keeps all samples
  int n_stages = 0;  ///< 0 keeps all samples

  std::int64_t every() const;  ///< factor^n_stages
};

/// The decimation that keeps at most `n_max` of `n` samples, in stages of the same factor, at most
/// 8.
Decimation decimation_to(std::int64_t n, std::int64_t n_max);

/// Fraction of the output rate up to which a decimated signal equals the signal, within 5e-4.
inline constexpr double decimated_band = 0.38;

/// Stages of decimation in series.
class Decimator {
 public:
  Decimator(const Decimation& decimation, Eigen::Index n_signals);

  /// Adds the next sample.
  /// @return the output sample that has become complete, if any
  std::optional<Eigen::VectorXd> add(const Eigen::VectorXd& x);

  /// Ends the signals.
  /// @return the remaining output samples
  std::vector<Eigen::VectorXd> finish();

 private:
  std::optional<Eigen::VectorXd> add_from(std::size_t stage, const Eigen::VectorXd& x);

  std::vector<DecimatorStage> stages_;
};

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
