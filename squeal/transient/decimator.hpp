#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "squeal/motion/state_archive.hpp"

namespace chladni::squeal {

/// Keeps one sample in `factor` of several signals, of which a windowed sinc has taken before what
/// the lower rate cannot hold, so that nothing is folded down. The sample j that comes out belongs
/// to the time of the sample j * factor that went in. At both ends the weights of the samples that
/// there are sum to one, so that a constant stays as it is everywhere. Its memory depends on
/// `factor` alone.
class DecimatorStage {
 public:
  /// @param factor  at least 2
  DecimatorStage(int factor, Eigen::Index n_signals);

  /// The next sample.
  /// @param x  [n_signals]
  /// @return [n_signals] the sample that is complete by now, if one has become so
  std::optional<Eigen::VectorXd> add(const Eigen::VectorXd& x);

  /// After the last sample: the next of those that only lack samples beyond the end.
  std::optional<Eigen::VectorXd> take_rest();

  void exchange(StateArchive& archive) { archive(samples_, n_in_, n_out_); }

 private:
  Eigen::VectorXd emit();

  int factor_;
  Eigen::Index half_;        ///< taps on either side of the middle one
  Eigen::VectorXd taps_;     ///< [2 half_ + 1]
  Eigen::MatrixXd samples_;  ///< [n_signals x 2 (2 half_ + 1)] the latest, each of them twice
  std::int64_t n_in_ = 0;
  std::int64_t n_out_ = 0;
};

/// How many samples are kept.
struct Decimation {
  int factor = 1;    ///< of each stage; 1 keeps all
  int n_stages = 0;  ///< none keeps all

  std::int64_t every() const;  ///< factor^n_stages
};

/// Keeps at most `n_max` of `n` samples, in stages of at most 8 that have one factor.
Decimation decimation_to(std::int64_t n, std::int64_t n_max);

/// Part of the rate that comes out up to which a decimated signal is the signal itself, to 5e-4.
inline constexpr double decimated_band = 0.38;

/// Stages of decimation one behind the other.
class Decimator {
 public:
  Decimator(const Decimation& decimation, Eigen::Index n_signals);

  /// @return as DecimatorStage::add
  std::optional<Eigen::VectorXd> add(const Eigen::VectorXd& x);

  /// @return the samples that are left after the last one
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
