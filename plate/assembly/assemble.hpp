#pragma once

#include <span>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The matrices of K u = f, M, C and H of the whole body after elimination of the couplings, with
/// n_c = dofs.n_components().
struct System {
  petsc::Matrix K;  ///< [n_c n_active x n_c n_active] AIJ, block size n_c; N/m, N, N m
  /// kg, kg m, kg m^2; size and type as K
  petsc::Matrix M;
  /// Viscous damping by dampers; null without one; N s/m, N s, N m s.
  petsc::Matrix C;
  /// Structural damping, sum of eta_e K_e over elements and springs, so that a harmonic motion has
  /// K + i H; null if no loss factor is above zero; units as K.
  petsc::Matrix H;
  DofMap dofs;
};

/// Assembles the matrices. Every rank computes all elements that touch one of its nodes and inserts
/// its own rows only, so K and M are symmetric and the same for any number of ranks, to the last
/// bit. Entries below 1e-14 sqrt(K_ii K_jj), and likewise in M, are round-off and dropped; only for
/// this the ranks exchange diagonals. Couplings and offsets are eliminated element by element: u_e
/// = T_e q gives K_e <- T_e^T K_e T_e, and likewise for M_e, masses, springs and dampers.
/// Components that `dofs` does not have are held at zero and are not part of the system.
/// @note   Collective on `comm`.
/// @throws chladni::Error as `map_sections` and `point_elements`.
System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm);

/// Assembles the matrices of a body of shells alone.
/// @note   Collective on `comm`.
/// @throws chladni::Error as `map_sections`.
System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm);

/// The mean position of all nodes, m. The rotations of `rigid_motions` turn about axes through it.
Eigen::Vector3d centre_of_nodes(const DofMap& dofs);

/// Unit translations along x, y, z and unit rotations about axes through the centre of the nodes,
/// as motions of the DOFs. Components that the nodes do not have are left out.
/// @param system  without averages and harmonics of rings, whose DOFs are no displacements of nodes
/// @return [n x 6] dense
/// @note   Collective.
petsc::Matrix rigid_motions(const System& system);

/// The work-equivalent forces f of the loads in K u = f. A load on a dependent node acts on the
/// nodes that it follows. Pressure and edge loads act on the surface and the edges of the mesh
/// itself, without the offsets of sections.
/// @return distributed as the rows of K; N, N m
/// @note   Collective on the communicator of `system.K`.
/// @throws chladni::Error for an unknown group, or one without nodes, edges or elements to load,
///         and for a moment about a drilling axis (drilling.hpp).
petsc::Vector load_vector(const mesh::Mesh& mesh, const System& system,
                          std::span<const Load> loads);

}  // namespace chladni::plate
