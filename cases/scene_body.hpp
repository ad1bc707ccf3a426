#pragma once

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mbs_export/responses/frequency_responses.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A modal body, and notes for the user about it.
struct SceneBody {
  mbs_export::ModalBody body;
  std::vector<std::string> notes;
};

/// The body that [body] of the scene describes.
/// @throws chladni::Error naming file, line and key of what the reduced system cannot give.
SceneBody scene_body(const scene::Scene& scene, const mbs_export::ReducedSystem& reduced);

}  // namespace chladni::cases

/// Frequency responses of reduced systems and bodies, without PETSc.

namespace chladni::cases {

/// The responses of a body that [response] asks for, damped as the body is and by the loss factor.
/// @throws chladni::Error naming file, line and key of what the body cannot answer.
mbs_export::FrequencyResponses body_responses(const scene::Scene& scene,
                                              const mbs_export::ModalBody& body);

/// The responses of the reduced system under `[body] fixed` with `[body] damping`: those of a body
/// that keeps all of its modes.
/// @throws chladni::Error naming file, line and key of what the system cannot answer.
mbs_export::FrequencyResponses reduced_responses(const scene::Scene& scene,
                                                 const mbs_export::ReducedSystem& reduced);

}  // namespace chladni::cases
