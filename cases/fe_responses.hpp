#pragma once

#include "cases/fe_solution.hpp"
#include "cases/phases.hpp"
#include "mbs_export/responses/frequency_responses.hpp"

/// Frequency responses of the FE model itself.
namespace chladni::cases {

/// The scene with the supports of its body, `[body] fixed`, instead of `[[support]]`. A scene
/// without [interface], which has no body, is returned unchanged.
scene::Scene held_as_body(const scene::Scene& scene);

/// The responses of the FE model that [response] asks for, with one factorisation for each
/// frequency and damping by `[body] damping` and the loss factor. The result has no provenance.
/// @param scene  with [response], and with the supports of the model
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, naming file, line and key, for a place that the model
///         does not have, a load on a DOF that does not move, modal damping, and an undamped
///         resonance.
mbs_export::FrequencyResponses fe_responses(const scene::Scene& scene, const SupportedModel& model,
                                            const linear::SolverOptions& solver, Phases& phases);

}  // namespace chladni::cases
