#pragma once

#include <optional>

#include "cases/sector_model.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// Fewer repetitions about the axis are none.
constexpr int least_sectors = 3;

/// One sector of a mesh that repeats so often, assembled.
/// @throws chladni::Error for a scene that cannot be reduced from it.
SectorModel sector_of(const scene::Scene& scene, const mesh::Mesh& whole, int count);

/// As the sector search of the scene's mesh says: one sector of a body that repeats, if the scene
/// can be reduced from it, assembled. What was found is told on stderr, and to who asked why the
/// whole body is taken.
std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole);

/// What is reduced.
struct MeshedScene {
  mesh::Mesh mesh;                    ///< of the whole body or of a sector
  std::optional<SectorModel> sector;  ///< on the first rank where it has been assembled already
};

/// The mesh of the scene, made by the first rank, which looks for sectors too.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
MeshedScene meshed_scene(const scene::Scene& scene);

}  // namespace chladni::cases
