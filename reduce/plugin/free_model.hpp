#pragma once

#include <vector>

#include "reduce/plugin/cms_impl.hpp"

namespace chladni::reduce::plugin {

/// All modes of the reduced model with free masters.
struct FreeModel {
  SmallMatrix X{0, 0};         ///< elastic modes
  std::vector<double> lambda;  ///< their eigenvalues, ascending
  PetscInt n_zero = 0;
  double rigid_residual = 0.0;
};

/// Solved on the first rank, so that ranks cannot differ by round-off; the same everywhere.
/// @note   Collective.
/// @throws chladni::Error on all ranks when K_r or M_r is not semidefinite.
FreeModel free_model_everywhere(const ReducedModel& model, MPI_Comm comm);

/// The modes that get an error: up to the range of the tolerance, or else up to the last
/// fixed-interface mode, not too many.
ReducedPairs certified_pairs(const FreeModel& free, const Settings& settings,
                             const ReducedModel& model);

}  // namespace chladni::reduce::plugin
