#pragma once

#include <functional>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The mesh of the scene, with its rings.
/// @throws chladni::Error as `mesh::generate`.
mesh::Mesh mesh_scene(const scene::Scene& scene);

/// Checks that the mesh has all groups of the scene.
/// @throws chladni::Error naming file, line and key of a group that it lacks.
void check_groups(const scene::Scene& scene, const mesh::Mesh& mesh);

/// Returns a part of a mesh, or all of it.
using ChooseMesh = std::function<mesh::Mesh(mesh::Mesh)>;

/// Makes the mesh on the first rank and sends it to all ranks.
/// @param choose  the part to be sent; called on the first rank
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, also as `check_groups`.
mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene, const ChooseMesh& choose = {});

}  // namespace chladni::cases
