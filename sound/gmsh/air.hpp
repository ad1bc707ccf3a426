#pragma once

#include "sound/air_of_gmsh.hpp"

namespace chladni::sound {

/// Meshes the air by Gmsh in this process.
/// @throws chladni::Error when Gmsh fails.
AirOfGmsh air_by_gmsh(const AirQuestion& question);

/// What `mesh_air` asks chladni-mesher for, in that program.
/// @throws chladni::Error as `air_by_gmsh`.
void answer_with_air(Unpacker& question, Packer& answer);

}  // namespace chladni::sound
