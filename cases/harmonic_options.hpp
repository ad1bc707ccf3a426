#pragma once

#include <vector>

#include "cases/sector_model.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

/// The rank that reduces a harmonic.
int rank_of_harmonic(int order);

/// The harmonics that this rank reduces, ascending.
std::vector<int> own_harmonics(int count);

/// The method of all harmonics; `automatic` without a tolerance is Craig and Bampton's.
reduce::MethodChoice harmonic_method(const reduce::ReduceOptions& wanted);

/// How each harmonic is reduced: a number of modes of the whole body becomes the frequency below
/// which it has them.
/// @note   Collective on all ranks.
reduce::ReductionOptions harmonic_options(const scene::Scene& scene, const SectorModel& model,
                                          const cyclic::SectorMatrices& matrices,
                                          const linear::SolverOptions& solver,
                                          const cyclic::IsHeld& is_held);

}  // namespace chladni::cases
