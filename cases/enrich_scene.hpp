#pragma once

#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/full_responses.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// True if an interface mode of the scene is to be computed in the whole model.
bool wants_full_responses(const scene::Scene& scene);

/// The loads of these interface modes and the forces of the scene's supports, at their omega0. If
/// the reduced model contains the responses of the whole free model to them, a body has the same
/// responses as the FE model.
/// @param masters  [n_m] global DOFs of the masters of `system`
/// @note   Collective.
/// @throws chladni::Error for a loaded DOF that is no master.
std::vector<reduce::HarmonicLoads> full_response_loads(const scene::Scene& scene,
                                                       const mbs_export::ReducedSystem& system,
                                                       const std::vector<PetscInt>& masters);

}  // namespace chladni::cases
