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
  /// works, because these need one shape for each motion.
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

/// Summary of a table over its range: the least stable motions at the ends, and the intervals in
/// which any motion grows.
StabilityProfile profile_of(const StabilityTable& table);

}  // namespace chladni::squeal
