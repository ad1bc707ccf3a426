#pragma once

#include "cases/mesh_errors.hpp"
#include "cases/size_of_mesh.hpp"
#include "linear/solver_options.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The part of an accuracy that the mesh may take; the reduction has the rest.
constexpr double share_of_mesh = 0.9;

/// Of the modes up to a frequency; of the first elastic one in any case.
/// @param omega  rad/s
/// @note   Collective, as all of this header.
MeshErrors errors_up_to(const scene::Scene& scene, const SupportedModel& model, double omega,
                        const linear::SolverOptions& solver);

/// A mesh that keeps the accuracy of a scene.
struct FoundMesh {
  MeshSize size;
  MeshErrors errors;
};

/// @param scene  with the supports under which its frequencies are meant
/// @throws chladni::Error when no mesh keeps the accuracy, with what the best one reached.
FoundMesh search_mesh(const scene::Scene& scene, const linear::SolverOptions& solver);

}  // namespace chladni::cases
