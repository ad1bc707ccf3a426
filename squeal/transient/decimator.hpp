#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/motion/state_archive.hpp"

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

  void exchange(StateArchive& archive) { archive(samples_, n_in_, n_out_); }

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

  void exchange(StateArchive& archive)
  {
    for (DecimatorStage& stage : stages_) archive(stage);
  }

 private:
  std::optional<Eigen::VectorXd> add_from(std::size_t stage, const Eigen::VectorXd& x);

  std::vector<DecimatorStage> stages_;
};

}  // namespace chladni::squeal
