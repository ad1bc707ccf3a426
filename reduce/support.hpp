#pragma once

#include <limits>
#include <vector>

#include "reduce/error_estimates.hpp"

namespace chladni::reduce {

/// A range of the spectrum: all eigenvalues up to lambda_max and one more, at most `most`.
struct SpectrumRange {
  double lambda_max = std::numeric_limits<double>::infinity();  ///< rad^2/s^2
  PetscInt most = std::numeric_limits<PetscInt>::max();
};

/// Elastic modes of a reduced model under a support.
struct SupportedModes {
  ReducedPairs pairs{.X = {}, .lambda = {}};  ///< ascending; those wanted, or more
  bool are_all = false;                       ///< true when the model has no other
  int n_zero = 0;       ///< number of zero-energy motions that the support leaves
  int n_free_zero = 0;  ///< number of zero-energy motions without a support
};

/// The support of the body whose frequencies a reduction certifies: it holds some of the masters.
class Support {
 public:
  Support() = default;
  virtual ~Support() = default;
  Support(const Support&) = delete;
  Support& operator=(const Support&) = delete;

  /// The held masters as global DOFs, the same list on every rank.
  virtual std::vector<PetscInt> held() const = 0;
  /// The elastic modes of a range. Called on the first rank only, which sends them to the others:
  /// round-off could let ranks differ.
  /// @throws chladni::Error when the model is no body with this support.
  virtual SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const = 0;
  /// The largest energy of the zero-energy motions without a support over the first elastic lambda;
  /// 0 is perfect. Called on the first rank only.
  /// @param modes  the result of `modes` for this model
  virtual double zero_energy(const ReducedModel& model, const SupportedModes& modes) const = 0;
};

}  // namespace chladni::reduce
