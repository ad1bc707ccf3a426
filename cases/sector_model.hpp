#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cyclic/harmonic_model.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "scene/scene.hpp"

/// A scene with one sector meshed.
namespace chladni::cases {

/// An interface node of the sector, as it is written to the file.
struct SectorNode {
  int node;      ///< of the DofMap
  int block;     ///< of the sector's DOFs
  int ring;      ///< index in SectorDofs::rings; -1 on the axis
  double angle;  ///< rad, in [0, 2 pi) before the turns
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
