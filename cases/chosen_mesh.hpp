#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/mesh_errors.hpp"
#include "cases/phases.hpp"
#include "linear/solver_options.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// A scene whose mesh is said, and what is known of the frequencies on it.
struct MeshChoice {
  scene::Scene scene;
  std::optional<MeshErrors> errors;  ///< of the body under its supports, where they were looked for
};

/// What holds the body of a scene (BodyOptions::fixed), as supports of its FE model.
std::vector<plate::Support> supports_of(const scene::Scene& scene);

/// With `accuracy` the cheapest mesh known that keeps it: coarse meshes of the orders there are,
/// without and with rows of elements at the edges, tell what each would need; the best one is
/// refined until the estimate of its error says so. Without, the scene's own mesh, with the errors
/// of its frequencies where the scene asks for these.
/// @param supports  under which the frequencies are meant
/// @note   Collective.
/// @throws chladni::Error when no mesh keeps the accuracy, with what the best one reached.
MeshChoice chosen_mesh(const scene::Scene& scene, const std::vector<plate::Support>& supports,
                       const linear::SolverOptions& solver, Phases& phases);

}  // namespace chladni::cases
