#pragma once

#include "cli/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace chladni::cli {

/// The mesh of the scene, with its rings.
/// @throws chladni::Error as mesh::generate.
mesh::Mesh mesh_scene(const Scene& scene);

/// The mesh of the first rank on all ranks.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
mesh::Mesh mesh_on_all_ranks(const Scene& scene);

}  // namespace chladni::cli
