#pragma once

#include "cli/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace chladni::cli {

/// The mesh of the scene, with its rings.
/// @throws chladni::Error as mesh::generate.
mesh::Mesh mesh_scene(const Scene& scene);

}  // namespace chladni::cli
