#pragma once

#include <vector>

#include "reduce/error_estimates.hpp"

namespace chladni::reduce {

/// Reduced pairs whose motions are zero in the same slaves: those of bending, and those in the
/// plane, of a flat body.
struct PairGroup {
  std::vector<PetscInt> pairs;  ///< ascending
  petsc::IndexSet set;          ///< rows of K_ss that move; null: all of them
  std::vector<PetscInt> rows;   ///< the same on this rank, counted from its first
};

/// The pairs in groups by the sets of slaves that neither K_ss nor M_ss couples; those that move
/// several sets together.
/// @note   Collective.
std::vector<PairGroup> pair_groups(const Condensation& system, const ReducedPairs& pairs);

}  // namespace chladni::reduce
