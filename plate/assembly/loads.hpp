#pragma once

#include <span>

#include "plate/assembly/assemble.hpp"
#include "plate/load_options.hpp"

namespace chladni::plate {

/// The work-equivalent forces of the loads, f in K u = f; those on dependent nodes act on what the
/// nodes follow. Pressure and edge loads are those of the mesh's own surface and edges.
/// @return distributed as the rows of K; N, N m
/// @note   Collective on the communicator of `system.K`.
/// @throws chladni::Error for an unknown group, or one without nodes, edges or elements to load,
///         and for a moment about the normal of a shell alone (drilling.hpp).
petsc::Vector load_vector(const mesh::Mesh& mesh, const System& system,
                          std::span<const Load> loads);

}  // namespace chladni::plate
