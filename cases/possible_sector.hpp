#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/ranks.hpp"
#include "cases/sector_model.hpp"
#include "mesh/mesh.hpp"
#include "reduce/reduction.hpp"
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

/// The responses of a scene's body that the harmonics of its sectors keep to a tolerance.
struct HarmonicResponses {
  cyclic::HarmonicGoal goal;
  std::vector<std::string> names;  ///< "track.z" for all nodes of a set
};

/// The responses of `[body] keep` with a tolerance, a third of which the reduction may use. The
/// response to a force at a node of a ring is a sum over the harmonics whose squares add up; if
/// each harmonic keeps the tolerance of its own responses, so do all together. Absent without a
/// tolerance, with another method than the mixed interface, under a support that couples harmonics
/// or holds all interface nodes, for moments, for forces on rings some of whose harmonics are no
/// masters, and for forces in a single direction of the plane.
/// @param whole  `described_whole`
std::optional<HarmonicResponses> harmonic_responses(const scene::Scene& scene,
                                                    const SectorModel& model,
                                                    const mbs_export::ReducedSystem& whole,
                                                    const SectorSupport& support);

/// The method of all harmonics; `automatic` without a tolerance is Craig-Bampton.
reduce::MethodChoice harmonic_method(const reduce::ReduceOptions& wanted);

/// The options of the reduction of each harmonic. A number of modes of the whole body is replaced
/// by the frequency below which it has that many.
/// @note   Collective on all ranks.
reduce::ReductionOptions harmonic_options(const scene::Scene& scene, const SectorModel& model,
                                          const cyclic::SectorMatrices& matrices,
                                          const linear::SolverOptions& solver,
                                          const cyclic::IsHeld& is_held,
                                          const HarmonicGroups& groups);

}  // namespace chladni::cases
