#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cyclic/harmonic_model.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "scene/scene.hpp"

/// A scene of which one sector is meshed.
namespace chladni::cases {

/// An interface node of the sector, as the file knows it.
struct SectorNode {
  int node;      ///< of the DofMap
  int block;     ///< of the DOFs
  int ring;      ///< index in SectorDofs::rings; -1 on the axis
  double angle;  ///< rad, in [0, 2 pi) before the turns
  Eigen::Vector3d drilling_axis;
};

/// The interface of the sector.
struct SectorInterface {
  std::vector<SectorNode> nodes;                    ///< each once; of the cut edges the first one's
  std::vector<std::string> axis_names, ring_names;  ///< of SectorDofs::axis and rings
};

struct SectorModel {
  mesh::Mesh mesh;
  std::vector<plate::PointMass> masses;  ///< lumped, of the sector: its share of those on the axis
  plate::System system;                  ///< of one rank
  cyclic::SectorDofs dofs;
  SectorInterface interface;
};

/// Assembles the sector of a scene; every rank has it whole.
/// @throws chladni::Error for what does not repeat with the sectors, naming it, and what harmonics
///         cannot do yet.
SectorModel sector_model(const scene::Scene& scene, mesh::Mesh mesh);

/// Attachment nodes of the whole body, sets and masters, without matrices.
/// @return with ring motion of the masters; rows and columns as in ReducedSystem
mbs_export::ReducedSystem described_whole(const scene::Scene& scene, const SectorModel& model);

/// The place of a master in ReducedSystem::masters.
int master_index(const mbs_export::ReducedSystem& whole, const SectorModel& model,
                 const cyclic::Master& master);

/// What the support holds of each harmonic, or nothing where it holds what harmonics share.
/// @param fixed  as BodyOptions::fixed
struct SectorSupport {
  std::vector<std::string> names;  ///< the entries of `fixed` that the certificate is for
  cyclic::IsHeld is_held;
};
SectorSupport sector_support(const scene::Scene& scene, const SectorModel& model);

}  // namespace chladni::cases
