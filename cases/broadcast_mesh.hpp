#pragma once

#include "mesh/mesh.hpp"

namespace chladni::cases {

/// The mesh of the first rank on all ranks.
/// @param mesh  what the first rank has; of the others ignored.
/// @note   Collective on all ranks.
mesh::Mesh broadcast(const mesh::Mesh& mesh);

}  // namespace chladni::cases
