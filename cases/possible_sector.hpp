#pragma once

#include <optional>

#include "cases/sector_model.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The least number of sectors that a body is reduced from.
constexpr int least_sectors = 3;

/// Assembles one sector of a mesh with `count` equal sectors.
/// @throws chladni::Error for a scene that cannot be reduced from it.
SectorModel sector_of(const scene::Scene& scene, const mesh::Mesh& whole, int count);

/// One sector of a periodic body, assembled, if the scene's sector search allows it and the scene
/// can be reduced from it. Prints on stderr what was found and, if the scene asked for sectors, why
/// the whole body is used.
std::optional<SectorModel> possible_sector(const scene::Scene& scene, const mesh::Mesh& whole);

/// The mesh that is reduced.
struct MeshedScene {
  mesh::Mesh mesh;  ///< of the whole body or of a sector
  /// set on the first rank if it has been assembled already
  std::optional<SectorModel> sector;
};

/// Makes the mesh of the scene on the first rank, which also searches for sectors, and sends it to
/// all.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike.
MeshedScene meshed_scene(const scene::Scene& scene);

}  // namespace chladni::cases
