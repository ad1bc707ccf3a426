#pragma once

#include <functional>
#include <optional>

#include "reduce/growing_model.hpp"
#include "reduce/mode_search.hpp"

namespace chladni::reduce {

/// About as few fixed-interface modes as keep the error estimates of a range of the spectrum below
/// a tolerance. Takes turns: `find_modes`, `is_enough`, until the answer is yes. Neither the modes
/// nor what their errors need are computed twice.
class ToleranceSearch {
 public:
  /// The pairs of a reduced model whose errors count, the same on every rank.
  using PairsOf = std::function<ReducedPairs(const ReducedModel&)>;

  /// What `system` refers to must outlive this.
  /// @param up_to_Hz  given: the tolerance is for `frequency_error` of all frequencies of the FE
  ///                  model up to here, and the pairs go some way beyond, since a reduced frequency
  ///                  is too high; absent: for eta^2 of each pair
  ToleranceSearch(const GrowingModel::System& system, double tolerance, PairsOf pairs_in_range,
                  std::optional<double> up_to_Hz = {});

  /// Finds as many modes as `is_enough` has predicted.
  /// @note   Collective.
  /// @throws chladni::Error when there are no more, or the eigen-solver does not converge.
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
  PetscInt least() const;
  PetscInt prediction() const;
  PetscInt n_complete() const;

  GrowingModel::System system_;
  double tolerance_;
  std::optional<double> up_to_Hz_;
  PairsOf pairs_in_range_;
  ModeSearch search_;
  std::optional<GrowingModel> model_;
  PetscInt n_asked_;
  std::vector<Tried> too_few_;
  PetscInt n_enough_ = 0;
};

}  // namespace chladni::reduce
