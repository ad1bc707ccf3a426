#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "reduce/response_errors.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The responses of a scene's body that its reduction is to keep.
struct SceneResponses {
  reduce::ResponseGoal goal;
  /// "track.z" stands for all nodes of the set; on the first rank, once the goal was asked
  std::shared_ptr<std::vector<std::string>> names;
};

/// Whether a reduction of the scene may come to keep responses.
bool may_keep_responses(const scene::Scene& scene);

/// The responses of `[body] keep` with a tolerance, where the loads act on masters; a third of the
/// tolerance is the reduction's, the rest the body's. Nothing without a tolerance.
/// @param described  nodes, sets and masters, in the order of `masters`
/// @param masters    [n_m] global DOFs
/// @param fixed      supports that hold masters
std::optional<SceneResponses> scene_responses(const scene::Scene& scene,
                                              mbs_export::ReducedSystem described,
                                              std::vector<PetscInt> masters,
                                              const std::vector<std::string>& fixed);

}  // namespace chladni::cases
