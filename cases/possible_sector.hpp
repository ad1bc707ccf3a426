#pragma once

#include <optional>

#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// With mesh.sectors = "auto": one sector of a body that repeats, if the scene can be reduced from
/// it. What was found, or why the whole body is taken, is told on stderr.
/// @param whole  on all ranks
/// @return the same on all ranks
std::optional<mesh::Mesh> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole);

}  // namespace chladni::cases
