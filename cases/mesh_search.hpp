#pragma once

#include "cases/mesh_errors.hpp"
#include "cases/size_of_mesh.hpp"
#include "linear/solver_options.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The share of an accuracy that the mesh may use; the rest is for the reduction.
constexpr double share_of_mesh = 0.9;

/// The least accuracy, of two digits, that a mesh with this error keeps.
double possible_error(double error_of_mesh);

/// A mesh that keeps the accuracy of a scene.
struct FoundMesh {
  MeshSize size;
  MeshErrors errors;
};

/// Searches the cheapest mesh that keeps the accuracy.
/// @param scene  with the supports under which its frequencies are meant
/// @note   Collective.
/// @throws chladni::Error when no mesh keeps the accuracy, with the error of the best one.
FoundMesh search_mesh(const scene::Scene& scene, const linear::SolverOptions& solver);

}  // namespace chladni::cases
