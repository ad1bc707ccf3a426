#pragma once

#include "cli/reduce_steps.hpp"

namespace chladni::cli {

/// Whether an interface mode of the scene is to be that of the whole model.
bool wants_full_responses(const Scene& scene);

/// The reduced system with room for the responses of the whole free model to the loads of those
/// interface modes, and to the forces of the scene's supports, at their omega0: columns behind the
/// fixed-interface modes. A body then answers these loads at omega0 as the FE model does.
/// @note   Collective.
/// @throws chladni::Error for a loaded DOF that is no master, and as reduce::full_responses.
SceneReduction with_full_responses(const Scene& scene, const FeModel& fe, SceneReduction reduced,
                                   Phases& phases);

}  // namespace chladni::cli
