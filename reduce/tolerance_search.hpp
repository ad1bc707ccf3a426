#pragma once

#include <functional>
#include <optional>

#include "reduce/growing_model.hpp"
#include "reduce/mode_search.hpp"

namespace chladni::reduce {

/// The tolerance that the modes must keep and its range.
struct ToleranceGoal {
  double tolerance;  ///< for `frequency_error`
  /// End of the range of FE frequencies. Reduced pairs somewhat above it count too, since reduced
  /// frequencies are too high.
  double up_to_Hz;
};

/// Finds about as few fixed-interface modes as keep the error estimates of a range of the spectrum
/// below a tolerance. All fixed-interface modes of the range are always taken: under supports that
/// hold all masters each mode of the basis is exact, and a missing one has no estimate. Also, the
/// reduced model must have a frequency for each one of the FE model in the range;
/// `GrowingModel::heavier_model` shows that. Call `find_modes` and `is_enough` in turn until the
/// latter returns true. Neither the modes nor the data of their errors are computed twice.
class ToleranceSearch {
 public:
  /// Returns the pairs of a reduced model whose errors count, the same on every rank.
  using PairsOf = std::function<ReducedPairs(const ReducedModel&)>;

  /// What `system` refers to must outlive this object.
  ToleranceSearch(const GrowingModel::System& system, const ToleranceGoal& goal,
                  PairsOf pairs_in_range, MemoryCheck require_memory = {});

  /// Finds the number of modes that `is_enough` predicted.
  /// @note   Collective.
  /// @throws chladni::Error when there are no more modes, the eigen-solver does not converge, or
  ///         the memory does not suffice.
  void find_modes();
  /// True when the modes keep the tolerance; the smallest number that does is then found by
  /// bisection.
  /// @note   Collective.
  bool is_enough();
  /// The modes that are enough.
  /// @note   Collective.
  FixedInterfaceModes modes() const { return search_.leading(n_enough_); }

 private:
  struct Tried {
    PetscInt n;
    double error;
  };

  double error(PetscInt n) const;
  bool may_lack_a_frequency(PetscInt n) const;
  double lambda_left_out(PetscInt n) const;
  PetscInt n_in_range() const;
  bool covers_range() const;
  PetscInt more_of_range() const;
  PetscInt least() const;
  PetscInt bisected(PetscInt too_few, PetscInt enough,
                    const std::function<bool(PetscInt)>& is_enough) const;
  PetscInt prediction() const;
  PetscInt n_complete() const;

  GrowingModel::System system_;
  ToleranceGoal goal_;
  PairsOf pairs_in_range_;
  ModeSearch search_;
  std::optional<GrowingModel> model_;
  PetscInt n_asked_;
  std::vector<Tried> too_few_;
  PetscInt n_enough_ = 0;
};

}  // namespace chladni::reduce
