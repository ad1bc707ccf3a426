#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "reduce/cyclic/harmonic_model.hpp"
#include "scene/scene.hpp"

/// A scene with one sector meshed.

namespace chladni::cases {

/// An interface node of the sector, as it is written to the file.
struct SectorNode {
  int node;            ///< of the DofMap
  int block;           ///< of the sector's DOFs
  int rotations = -1;  ///< block of its rotations, if that is another one
  int ring;            ///< index in SectorDofs::rings; -1 on the axis
  double angle;        ///< rad, in [0, 2 pi) before the turns
  Eigen::Vector3d drilling_axis;
};

/// The interface of the sector.
struct SectorInterface {
  /// Each once; of nodes on the cut edges those of the first edge.
  std::vector<SectorNode> nodes;
  std::vector<std::string> axis_names, ring_names;  ///< of SectorDofs::axis and rings
};

/// The assembled sector of a scene.
struct SectorModel {
  mesh::Mesh mesh;
  /// Lumped masses of the sector; of those on the axis its share.
  std::vector<plate::PointMass> masses;
  plate::System system;  ///< on one rank
  cyclic::SectorDofs dofs;
  SectorInterface interface;
};

/// Assembles the sector of a scene; every rank has it whole.
/// @throws chladni::Error for what is not periodic, naming it, and for what is not implemented for
///         harmonics.
SectorModel sector_model(const scene::Scene& scene, mesh::Mesh mesh);

/// The attachment nodes, sets and masters of the whole body, without matrices.
/// @return with ring motion of the masters; rows and columns as in ReducedSystem
mbs_export::ReducedSystem described_whole(const scene::Scene& scene, const SectorModel& model);

/// The place of a master in ReducedSystem::masters.
int master_index(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                 const cyclic::Master& master);

/// The masters that the support holds in each harmonic. Entries of the support that would couple
/// harmonics are left out.
struct SectorSupport {
  std::vector<std::string> names;  ///< the entries of `fixed` that the certificate is for
  cyclic::IsHeld is_held;
};
/// The support of the scene's body in the harmonics of its sectors.
SectorSupport sector_support(const scene::Scene& scene, const SectorModel& model);

}  // namespace chladni::cases

/// Checks that refuse, by name, what in a scene is not periodic or is not implemented for
/// harmonics.

namespace chladni::cases {

/// True if a node is on the z axis.
/// @param node  of the DofMap
bool is_on_axis(const SectorModel& model, int node);

/// Checks that the scene has nothing that is not implemented for harmonics.
/// @throws chladni::Error when it has.
void refuse_unsupported(const scene::Scene& scene);

/// True if a mass or a spring does not change under any turn about the z axis.
bool turns_with_sectors(const plate::PointMass& mass);
bool turns_with_sectors(const plate::Spring& spring);

/// Checks the averaging couplings. A coupling is allowed if each sector has a group of its own,
/// without nodes of the cut edges, which two sectors share; its reference node must be no interface
/// node.
/// @throws chladni::Error for another averaging coupling.
void check_means(const scene::Scene& scene, const SectorModel& model);

/// Checks that the nodes of a ring are equally spaced on one circle of the whole body.
/// @throws chladni::Error when they are not.
void check_ring(const SectorModel& model, const std::string& name,
                std::span<const SectorNode> nodes, const cyclic::Ring& ring);

/// Checks the deviations of single sectors.
/// @throws chladni::Error for a deviating mass or spring on the axis or on a cut edge, and for
///         section forces of a group whose section deviates.
void check_deviations(const scene::Scene& scene, const SectorModel& model);

/// The assembled matrices of the sector.
/// @param comm  of the ranks that reduce a harmonic together
cyclic::SectorMatrices matrices_of(const SectorModel& model, MPI_Comm comm);

/// The mirror plane of positions and matrices; absent if the sector has none.
std::optional<cyclic::Mirror> mirror_of(const SectorModel& model,
                                        const cyclic::SectorMatrices& matrices);

}  // namespace chladni::cases
