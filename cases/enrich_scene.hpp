#pragma once

#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/full_responses.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// Whether an interface mode of the scene is to be that of the whole model.
bool wants_full_responses(const scene::Scene& scene);

/// The loads of those interface modes, and the forces of the scene's supports, at their omega0.
/// With room for the responses of the whole free model to these a body answers them as the FE model
/// does.
/// @param masters  [n_m] global DOFs of the masters of `system`
/// @note   Collective.
/// @throws chladni::Error for a loaded DOF that is no master.
std::vector<reduce::HarmonicLoads> full_response_loads(const scene::Scene& scene,
                                                       const mbs_export::ReducedSystem& system,
                                                       const std::vector<PetscInt>& masters);

}  // namespace chladni::cases
