#pragma once

#include "cases/fe_solution.hpp"
#include "cases/phases.hpp"
#include "mbs_export/responses/frequency_responses.hpp"

/// Frequency responses of the FE model itself.
namespace chladni::cases {

/// The scene with the supports of its body, `[body] fixed`, in place of `[[support]]`; a scene
/// without [interface], which has no body, as it is.
scene::Scene held_as_body(const scene::Scene& scene);

/// What [response] asks of the FE model, one factorisation for each frequency; damped by
/// `[body] damping` and the loss factor. Without provenance.
/// @param scene  with [response], and held as the model
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, naming file, line and key, for a place that the model
///         does not have, a load on what does not move, modal damping, and an undamped resonance.
mbs_export::FrequencyResponses fe_responses(const scene::Scene& scene, const SupportedModel& model,
                                            const linear::SolverOptions& solver, Phases& phases);

}  // namespace chladni::cases
