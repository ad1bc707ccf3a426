#pragma once

#include <functional>
#include <optional>

#include "reduce/growing_model.hpp"
#include "reduce/mode_search.hpp"

namespace chladni::reduce {

/// What is asked of the modes.
struct ToleranceGoal {
  double tolerance;  ///< of `frequency_error`
  /// End of the range, in which lie frequencies of the FE model: the pairs go some way beyond it,
  /// since a reduced frequency is too high.
  double up_to_Hz;
};

/// About as few fixed-interface modes as keep the error estimates of a range of the spectrum below
/// a tolerance. All fixed-interface modes of the range are taken, whatever the estimates say: where
/// the masters are held every mode that there is is exact. And no frequency of the FE model in the
/// range may be without one of the reduced model, as `GrowingModel::heavier_model` shows. Takes
/// turns: `find_modes`, `is_enough`, until the answer is yes. Neither the modes nor what their
/// errors need are computed twice.
class ToleranceSearch {
 public:
  /// The pairs of a reduced model whose errors count, the same on every rank.
  using PairsOf = std::function<ReducedPairs(const ReducedModel&)>;

  /// What `system` refers to must outlive this.
  ToleranceSearch(const GrowingModel::System& system, const ToleranceGoal& goal,
                  PairsOf pairs_in_range, MemoryCheck require_memory = {});

  /// Finds as many modes as `is_enough` has predicted.
  /// @note   Collective.
  /// @throws chladni::Error when there are no more, the eigen-solver does not converge, or the
  ///         memory does not suffice.
  void find_modes();
  /// Whether the modes keep the tolerance; if so, finds out with how many less they would.
  /// @note   Collective.
  bool is_enough();
  /// As many as are enough.
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
