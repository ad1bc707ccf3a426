#pragma once

#include <Eigen/Core>
#include <atomic>
#include <list>
#include <optional>
#include <vector>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_table.hpp"
#include "squeal/stability/exponent_branches.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// All motions of a disc that need not be axisymmetric, by Hill's method (hill.hpp): characteristic
/// exponents followed over the parameter (exponent_branches.hpp), on 32 values or more. Where the
/// growth of a motion has an extremum near zero between the values, it is looked for there. What is
/// found of a motion is kept for the next table.
class TurningMotions {
 public:
  /// Keeps a reference to the brake. The band of the search does not matter.
  /// @throws chladni::Error where Hill's method does.
  TurningMotions(const FlexibleDisc& brake, const StabilityCase& search);
  TurningMotions(const TurningMotions&) = delete;
  TurningMotions& operator=(const TurningMotions&) = delete;

  /// Whether these are the motions of this brake over the values of this search.
  bool are_of(const FlexibleDisc& brake, const StabilityCase& search) const;

  /// The table of the motions that have a frequency of the band. It has neither families of modes
  /// nor shares nor works, which need one shape for each motion.
  /// @throws chladni::Error where Hill's method does.
  StabilityTable table(const std::optional<FrequencyBand>& band);

  /// How often the exponents of a value were computed so far.
  int n_exponents() const { return n_exponents_; }

 private:
  const FlexibleDisc& brake_;
  StabilityCase search_;
  ExponentsAt exponents_;
  std::atomic<int> n_exponents_ = 0;
  std::vector<ExponentSample> samples_;
  std::vector<std::optional<StabilityBranch>> branches_;  ///< those that a table had
};

/// The tables of one run of several analyses: the motions of the same brake over the same values
/// are computed once, by the analysis that needs them first.
class TurningTables {
 public:
  /// Keeps a reference to the brake.
  /// @throws chladni::Error where Hill's method does.
  StabilityTable table(const FlexibleDisc& brake, const StabilityCase& search);

  /// How often the exponents of a value were computed so far.
  int n_exponents() const;

 private:
  std::list<TurningMotions> motions_;
};

/// The table of one analysis by itself.
/// @throws chladni::Error where Hill's method does.
StabilityTable turning_table(const FlexibleDisc& brake, const StabilityCase& search);

/// What a table says of the range as a whole: the least stable motions at its ends, and where any
/// of its motions grows.
StabilityProfile profile_of(const StabilityTable& table);

}  // namespace chladni::squeal
