#pragma once

#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A modal body, and what is to be told of it.
struct SceneBody {
  mbs_export::ModalBody body;
  std::vector<std::string> notes;
};

/// The body of [body] of the scene.
/// @throws chladni::Error naming file, line and key of what the scene asks for in vain.
SceneBody scene_body(const scene::Scene& scene, const mbs_export::ReducedSystem& reduced);

}  // namespace chladni::cases
