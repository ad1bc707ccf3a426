#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/phases.hpp"
#include "linear/solver_options.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A scene with a fixed mesh, and the errors of the frequencies on it.
struct MeshChoice {
  scene::Scene scene;
  /// of the body under its supports, if they were estimated
  std::optional<MeshErrors> errors;
};

/// The supports of the body of a scene (BodyOptions::fixed) as supports of its FE model.
std::vector<plate::Support> supports_of(const scene::Scene& scene);

/// With `accuracy`, the cheapest mesh found that keeps it: coarse meshes of all available orders,
/// with and without rows of elements at the edges, show which size each would need, and the best
/// one is refined until its estimated error is small enough. Without `accuracy`, the scene's own
/// mesh, with the errors of its frequencies if the scene asks for them.
/// @param supports  under which the frequencies are meant
/// @note   Collective.
/// @throws chladni::Error when no mesh keeps the accuracy, with the error of the best one.
MeshChoice chosen_mesh(const scene::Scene& scene, const std::vector<plate::Support>& supports,
                       const linear::SolverOptions& solver, Phases& phases);

}  // namespace chladni::cases
