#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/response_errors.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The responses of a scene's body that its reduction keeps to a tolerance.
struct SceneResponses {
  reduce::ResponseGoal goal;
  /// "track.z" for all nodes of a set; filled on the first rank when the goal is called.
  std::shared_ptr<std::vector<std::string>> names;
};

/// True if a reduction of the scene may have to keep responses.
bool may_keep_responses(const scene::Scene& scene);

/// The responses of `[body] keep` with a tolerance, if the loads act on masters. The reduction may
/// use a third of the tolerance, the body the rest. Absent without a tolerance.
/// @param described  nodes, sets and masters, in the order of `masters`
/// @param masters    [n_m] global DOFs
/// @param fixed      supports that hold masters
std::optional<SceneResponses> scene_responses(const scene::Scene& scene,
                                              mbs_export::ReducedSystem described,
                                              std::vector<PetscInt> masters,
                                              const std::vector<std::string>& fixed);

}  // namespace chladni::cases
