#pragma once

#include <functional>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The mesh of the scene, with its rings.
/// @throws chladni::Error as mesh::generate.
mesh::Mesh mesh_scene(const scene::Scene& scene);

/// @throws chladni::Error naming file, line and key of a group in the scene that the mesh lacks.
void check_groups(const scene::Scene& scene, const mesh::Mesh& mesh);

/// A part of a mesh, or all of it.
using ChooseMesh = std::function<mesh::Mesh(mesh::Mesh)>;

/// The mesh of the first rank on all ranks.
/// @param choose  what of it, on the first rank
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike; also as check_groups.
mesh::Mesh mesh_on_all_ranks(const scene::Scene& scene, const ChooseMesh& choose = {});

}  // namespace chladni::cases
