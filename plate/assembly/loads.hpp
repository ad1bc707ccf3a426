#pragma once

#include <span>

#include "plate/assembly/assemble.hpp"
#include "plate/load_options.hpp"

namespace chladni::plate {

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
