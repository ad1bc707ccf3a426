#pragma once

#include <Eigen/Core>

#include <atomic>
#include <functional>
#include <list>
#include <optional>
#include <vector>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/stability/hill.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Motions of a disc that need not be axisymmetric at one value of a parameter, by Hill's method.
struct ExponentSample {
  double value;          ///< value of the parameter
  double speed;          ///< rotation speed at that value, rad/s
  HillExponents motion;  ///< lambda[j] belongs to the same motion in all samples
  /// [n] integers that make lambda + i turns speed continuous in the parameter. They are needed
  /// because the replica chosen for a motion may change from value to value.
  Eigen::VectorXd turns;

  Eigen::Index size() const { return motion.lambda.size(); }
  double growth(Eigen::Index j) const { return motion.lambda[j].real(); }
  double frequency_Hz(Eigen::Index j) const;
  /// Growth within the estimated error does not count as instability.
  bool is_unstable(Eigen::Index j) const { return growth(j) > motion.error; }
  /// An estimate may be off by its own doubt.
  double doubt_of(Eigen::Index j) const { return motion.error - motion.doubt[j]; }
  StabilityPoint point(Eigen::Index j) const { return {value, growth(j), frequency_Hz(j)}; }
};

/// The exponents at a value of the parameter in any order, with turns = 0.
using ExponentsAt = std::function<ExponentSample(double value)>;

/// Samples at ascending values with one motion in each column. A motion is matched by the distance
/// of lambda from its extrapolation, modulo i nu speed. A change of the replica is penalised
/// slightly, so that motions of other frequencies are not mistaken for replicas.
/// @param values  [m], m > 0
std::vector<ExponentSample> followed_exponents(const ExponentsAt& exponents,
                                               const Eigen::VectorXd& values);

/// Intervals in which motion j grows. Extrema of the growth between samples that may cross zero are
/// located by interval halving, so that short intervals are found as well. A limit between two
/// samples is the root of the growth, within 1e-4 of their distance.
std::vector<UnstableInterval> unstable_intervals(const ExponentsAt& exponents,
                                                 const std::vector<ExponentSample>& samples,
                                                 Eigen::Index j);

/// All motions of a disc that need not be axisymmetric, by Hill's method (hill.hpp): characteristic
/// exponents followed over the parameter (exponent_branches.hpp) at 32 or more values. Extrema of
/// the growth near zero between the values are searched. The results for a motion are kept for
/// later tables.
class TurningMotions {
 public:
  /// Keeps a reference to the brake; the band of the search is ignored.
  /// @throws chladni::Error as Hill's method.
  TurningMotions(const FlexibleDisc& brake, const StabilityCase& search);
  TurningMotions(const TurningMotions&) = delete;
  TurningMotions& operator=(const TurningMotions&) = delete;

  /// Whether these are the motions of this brake over the values of this search.
  bool are_of(const FlexibleDisc& brake, const StabilityCase& search) const;

  /// The table of the motions with a frequency in the band. It has no families of modes, shares and
  /// works, because these need one shape for each motion. Where a motion is not expected to grow
  /// its exponent is an estimate by the second order of the harmonics.
  /// @throws chladni::Error as Hill's method.
  StabilityTable table(const std::optional<FrequencyBand>& band);

  /// Number of evaluations of the exponents so far.
  int n_exponents() const { return n_exponents_; }

 private:
  const FlexibleDisc& brake_;
  StabilityCase search_;
  ExponentsAt exponents_;
  std::atomic<int> n_exponents_ = 0;
  std::vector<ExponentSample> samples_;
  /// Branches that an earlier table contained.
  std::vector<std::optional<StabilityBranch>> branches_;
};

/// Tables for several analyses of one run: the motions of a brake over the same values are computed
/// once, by the first analysis that needs them.
class TurningTables {
 public:
  /// The table of a search. Keeps a reference to the brake.
  /// @throws chladni::Error as Hill's method.
  StabilityTable table(const FlexibleDisc& brake, const StabilityCase& search);

  /// Number of evaluations of the exponents so far.
  int n_exponents() const;

 private:
  std::list<TurningMotions> motions_;
};

/// The table of a single analysis.
/// @throws chladni::Error as Hill's method.
StabilityTable turning_table(const FlexibleDisc& brake, const StabilityCase& search);

/// Largest growth rates over the speeds and a parameter by Hill's method, with their error.
/// @throws chladni::Error as Hill's method.
StabilityMap turning_map(const FlexibleDisc& brake, const MapCase& range, const SpeedRange& speeds);

/// The first loss of stability in a table over the speed, absent where there is none, with the
/// error that the method leaves: of the search, and that of the growth over its slope.
std::optional<CriticalSpeed> turning_critical_speed(const FlexibleDisc& brake,
                                                    const StabilityTable& table);

/// Summary of a table over its range: the least stable motions at the ends, and the intervals in
/// which any motion grows.
StabilityProfile profile_of(const StabilityTable& table);

}  // namespace chladni::squeal
