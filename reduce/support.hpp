#pragma once

#include <limits>
#include <vector>

#include "reduce/error_estimates.hpp"

namespace chladni::reduce {

/// The part of a spectrum that is wanted: all eigenvalues up to lambda_max and one more, at most
/// `most`.
struct SpectrumRange {
  double lambda_max = std::numeric_limits<double>::infinity();  ///< rad^2/s^2
  PetscInt most = std::numeric_limits<PetscInt>::max();
};

/// Elastic modes of a reduced model under a support.
struct SupportedModes {
  ReducedPairs pairs{.X = {}, .lambda = {}};  ///< as wanted or more, ascending
  bool are_all = false;                       ///< that there are
  int n_zero = 0;                             ///< zero-energy motions that the support leaves
  int n_free_zero = 0;                        ///< and without any support
};

/// What holds the body whose frequencies a reduction certifies: some of the masters.
class Support {
 public:
  Support() = default;
  virtual ~Support() = default;
  Support(const Support&) = delete;
  Support& operator=(const Support&) = delete;

  /// Global DOFs, the same list on every rank.
  virtual std::vector<PetscInt> held() const = 0;
  /// The elastic modes of a range. Asked on the first rank only: the others are told, since
  /// round-off could let them differ.
  /// @throws chladni::Error when the model is no body that is held so.
  virtual SupportedModes modes(const ReducedModel& model, const SpectrumRange& wanted) const = 0;
  /// The energy of the zero-energy motions without support over the first elastic lambda; 0 is
  /// perfect. On the first rank only.
  /// @param modes  of this model
  virtual double zero_energy(const ReducedModel& model, const SupportedModes& modes) const = 0;
};

}  // namespace chladni::reduce
