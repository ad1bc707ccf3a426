#pragma once

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
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
