#pragma once

#include <Eigen/Core>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/elements/shell_resultants.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The motion of every node, dependent ones included, from the DOFs of the system.
/// @param q  distributed as the rows of K
/// @return [n_nodes x 6] u and theta of DofMap's nodes, on every rank; m, rad
/// @note   Collective on the communicator of `q`.
Eigen::MatrixXd node_motions(const DofMap& dofs, Vec q);

/// The forces and moments of the supports on the body.
/// @param held      the DOFs that supports hold; other rows of the residual are round-off
/// @param residual  K u - f, distributed as the rows of K
/// @return [n_nodes x 6] N, N m at DofMap's nodes, on every rank
/// @note   Collective on the communicator of `residual`.
Eigen::MatrixXd reactions(const DofMap& dofs, const std::vector<int>& held, Vec residual);

/// Section forces at the nodes of the group of one section: those of each element are extrapolated
/// to its nodes and averaged over the elements of the group that meet there. If neighbours are
/// oriented differently, moments and shear forces refer to the normal of the majority. At a kink
/// inside a group the average has no meaning.
/// @return rows as the nodes of the mesh, zero at nodes outside the group; on every rank
/// @note   Collective on `comm`, over which the elements are divided.
ShellResultants nodal_resultants(const mesh::Mesh& mesh, const ShellSection& section,
                                 const Eigen::MatrixXd& motions, MPI_Comm comm);

/// Stresses at the nodes of the group of one section of solids: those of each element where they
/// are most accurate are extrapolated to its nodes and averaged over the elements of the group that
/// meet there.
/// @return [n_nodes of the mesh x 6] xx, yy, zz, xy, yz, xz, Pa; zero outside the group; on every
///         rank
/// @note   Collective on `comm`, over which the elements are divided.
Eigen::MatrixXd nodal_stresses(const mesh::Mesh& mesh, const SolidSection& section,
                               const Eigen::MatrixXd& motions, MPI_Comm comm);

/// The strain energy u_e^T K_e u_e / 2 of each element in each motion.
/// @param motions  [6 n x k] m, rad; row 6 i + c is component c of node i. Rows behind those of the
///                 nodes of the mesh have no influence.
/// @return [n_elements x k] J, by blocks; on every rank
/// @note   Collective on `comm`, over which the elements are divided.
Eigen::MatrixXd element_energies(const mesh::Mesh& mesh, const Structure& structure,
                                 const Eigen::MatrixXd& motions, MPI_Comm comm);

}  // namespace chladni::plate
