#pragma once

#include "cases/reduce_steps.hpp"
#include "cases/stressed_states.hpp"

namespace chladni::cases {

/// The geometric stiffness of the FE model in the coordinates of the reduced system, for each load.
/// @note   Collective.
mbs_export::Stiffening stiffening(const scene::Scene& scene, const FeModel& fe,
                                  const SceneReduction& reduced, const StressedStates& stressed);

}  // namespace chladni::cases
