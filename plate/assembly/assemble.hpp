#pragma once

#include <span>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// K u = f, M, C and H of the whole body after elimination of the couplings; n_c =
/// dofs.n_components().
struct System {
  petsc::Matrix K;  ///< [n_c n_active x n_c n_active] AIJ, block size n_c; N/m, N, N m
  petsc::Matrix M;  ///< same; kg, kg m, kg m^2
  petsc::Matrix C;  ///< of the dampers; null without one; N s/m, N s, N m s
  /// Structural damping, sum of eta_e K_e over elements and springs: K + i H at a harmonic motion;
  /// null where no loss factor is above zero; as K.
  petsc::Matrix H;
  DofMap dofs;
};

/// Assembles the matrices. Every rank computes all elements that touch a node of its own and
/// inserts its own rows only, so that K and M are the same to the last bit for any number of ranks,
/// and symmetric to the last bit. What is below 1e-14 sqrt(K_ii K_jj) is round-off and no entry, in
/// M likewise; for this alone the ranks exchange diagonals. Couplings and offsets are eliminated
/// element by element, K_e <- T_e^T K_e T_e and M_e likewise, with u_e = T_e q; so are masses,
/// springs and dampers. Components that `dofs` does not have are held at zero and are not part of
/// the system.
/// @note   Collective on `comm`.
/// @throws chladni::Error as map_sections and point_elements.
System assemble(const mesh::Mesh& mesh, const Structure& structure, DofMap dofs, MPI_Comm comm);

/// Of shells alone.
System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm);

}  // namespace chladni::plate
