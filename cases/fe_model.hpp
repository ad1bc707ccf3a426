#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include "cases/phases.hpp"
#include "linear/kernels/forms.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/dof_map.hpp"
#include "reduce/reduction.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The attachment nodes of a scene in the FE system, and the masters. Masters are all DOFs of these
/// nodes; of a ring that has harmonics as DOFs they are the wanted harmonics, after all others.
struct Attachments {
  std::vector<int> nodes;  ///< indices into DofMap::positions, each once, in the scene's order
  std::vector<mbs_export::AttachmentSet> sets;
  /// Their `node` is a place in `nodes`.
  std::vector<mbs_export::MasterDof> masters;
  std::vector<int> master_dofs;                ///< [n_m] of K
  std::vector<Eigen::Vector3d> drilling_axes;  ///< of the nodes, as in mbs_export::AttachmentNode
};

/// Finds the attachment nodes and masters.
/// @param names  groups or rings of the mesh, rings of harmonics, or reference nodes of couplings
/// @throws chladni::Error for an unknown name, naming those that exist, and for an attachment node
///         that depends on a coupling.
Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names);

/// True if a node of the set moves by the harmonics of a ring.
bool has_ring_nodes(const Attachments& attachments, const plate::DofMap& dofs,
                    const mbs_export::AttachmentSet& set);

/// F: the motion of the attachment nodes by a unit amplitude of each master.
/// @return [6 n_nodes x n_m]
Eigen::MatrixXd master_shapes(const Attachments& attachments, const plate::DofMap& dofs);

/// The number of a node in files: that of the mesh, or a number after them for a reference node.
std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node);

}  // namespace chladni::cases

/// The data that the steps of `reduce_scene` pass on.

namespace chladni::cases {

struct FeModel {
  mesh::Mesh mesh;
  plate::System system;
  Attachments attachments;
};

/// The reduction of an FE model, and the system that is written.
struct SceneReduction {
  reduce::FactoredBody body;
  reduce::Reduction reduction;
  std::vector<int> places;           ///< of the file's coordinates in the model
  mbs_export::ReducedSystem system;  ///< in the order of the file
  int n_modes;                       ///< fixed-interface or free-interface modes
  double modes_residual;             ///< largest residual of the fixed-interface modes
};

/// The sections, masses and springs of the scene's body; refers to the scene.
plate::Structure structure_of(const scene::Scene& scene);

/// @throws chladni::Error naming a section whose material has no density, for what needs mass
void expect_mass(const scene::Scene& scene);

/// A matrix of the FE model in the coordinates of the file.
/// @note   Collective.
Eigen::MatrixXd projected(const SceneReduction& reduced, Mat A,
                          linear::FormSymmetry symmetry = linear::FormSymmetry::none);

/// True if the zero-energy motions are the rigid-body motions of the nodes: no spring goes to the
/// ground, and no node moves by a combination of other DOFs.
bool geometry_tells_motions(const scene::Scene& scene, const FeModel& fe);

/// The input of the reduction, taken from the FE model of a scene, which loses its matrices. They
/// are viewed before if options say so. The result refers to the model for the names of its DOFs.
/// @note   Collective.
reduce::Body body_of(const scene::Scene& scene, FeModel& fe);

/// The reduced system without its matrices: title, nodes, sets and masters.
mbs_export::ReducedSystem described_system(const scene::Scene& scene, const FeModel& fe);

/// The supports of the scene's body that hold masters. Supports that hold nodes of a ring of
/// harmonics are left out, since they leave a residual that the certificate does not include.
std::vector<std::string> certified_support(const scene::Scene& scene, const FeModel& fe);

/// Returns the rows of the transformation for a list of DOFs, [n x n_FE].
using RowsOf = std::function<Eigen::MatrixXd(const std::vector<int>& dofs)>;

/// The rows of the transformation on this rank.
struct OwnRows {
  Eigen::Index n_columns;
  std::function<bool(int dof)> has;
  RowsOf rows_of;  ///< zero for DOFs that this rank does not have
};

/// A mesh and its DOFs.
struct MeshedDofs {
  const mesh::Mesh& mesh;
  const plate::DofMap& dofs;
};

/// Displacement and rotation of nodes per unit of each reduced coordinate: row 6 k + c is component
/// c of nodes[k]. Dependent nodes follow their reference nodes; components that the model does not
/// have are zero.
/// @return [6 n x n_FE], m and rad per unit of each coordinate
Eigen::MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                          const RowsOf& rows_of);

/// The displacements alone, row 3 k + c.
/// @return [3 n x n_FE], m per unit of each coordinate
Eigen::MatrixXd displacement_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                                  const RowsOf& rows_of);

}  // namespace chladni::cases
