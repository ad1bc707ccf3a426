#pragma once

#include "cases/harmonic_groups.hpp"
#include "cases/sector_model.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cases {

/// The method of all harmonics; `automatic` without a tolerance is Craig-Bampton.
reduce::MethodChoice harmonic_method(const reduce::ReduceOptions& wanted);

/// The options of the reduction of each harmonic. A number of modes of the whole body is replaced
/// by the frequency below which it has that many.
/// @note   Collective on all ranks.
reduce::ReductionOptions harmonic_options(const scene::Scene& scene, const SectorModel& model,
                                          const cyclic::SectorMatrices& matrices,
                                          const linear::SolverOptions& solver,
                                          const cyclic::IsHeld& is_held,
                                          const HarmonicGroups& groups);

}  // namespace chladni::cases
