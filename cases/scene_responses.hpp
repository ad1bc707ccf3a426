#pragma once

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/responses/frequency_responses.hpp"
#include "scene/scene.hpp"

/// Frequency responses of what a reduction left of the FE model. PETSc is not needed.
namespace chladni::cases {

/// What [response] asks of a body, damped as the body is and by the loss factor.
/// @throws chladni::Error naming file, line and key of what it asks in vain.
mbs_export::FrequencyResponses body_responses(const scene::Scene& scene,
                                              const mbs_export::ModalBody& body);

/// The same of the reduced system under `[body] fixed` with `[body] damping`: of a body that keeps
/// all of its modes.
/// @throws chladni::Error likewise.
mbs_export::FrequencyResponses reduced_responses(const scene::Scene& scene,
                                                 const mbs_export::ReducedSystem& reduced);

}  // namespace chladni::cases
