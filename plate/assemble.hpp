#pragma once

#include <span>

#include "common/petsc.hpp"
#include "mesh/mesh.hpp"
#include "plate/dof_map.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// K u = f and M of the whole body after elimination of the couplings.
struct System {
  petsc::Matrix K;  ///< [6 n_active x 6 n_active] AIJ, block size 6; N/m, N, N m
  petsc::Matrix M;  ///< same, zeros dropped; kg, kg m, kg m^2
  DofMap dofs;
};

/// Assembles K and M. Every rank computes all elements that touch a node of its own and inserts its
/// own rows only: no communication, and K and M are the same to the last bit for any number of
/// ranks. Couplings and offsets are eliminated element by element, K_e <- T_e^T K_e T_e and M_e
/// likewise, with u_e = T_e q.
/// @note   Collective on `comm`.
/// @throws chladni::Error when an element has no section, or a section has no elements.
System assemble(const mesh::Mesh& mesh, std::span<const ShellSection> sections, DofMap dofs,
                MPI_Comm comm);

}  // namespace chladni::plate
