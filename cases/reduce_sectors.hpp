#pragma once

#include "cases/possible_sector.hpp"
#include "cases/reduce_scene.hpp"

namespace chladni::cases {

/// Reduces a scene with one sector meshed, harmonic by harmonic; the ranks share the harmonics. The
/// reduced system is that of the whole body: its masters are the DOFs of nodes on the axis and the
/// harmonics of rings, its modes come in exact pairs.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, also for what is not implemented for sectors.
ReduceSummary reduce_sectors(const scene::Scene& scene, MeshedScene meshed,
                             const linear::SolverOptions& solver, Phases& phases);

}  // namespace chladni::cases
