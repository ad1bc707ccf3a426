#pragma once

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"
#include "mesh/packing.hpp"

namespace chladni::mesh {

void pack(Packer& packer, const Mesh& mesh);

/// A mesh that another process of this program packed. Whatever the bytes are, its sizes, indices
/// and numbers fit together.
/// @throws chladni::Error when they do not.
Mesh unpack_mesh(Unpacker& unpacker);

/// What a deck says besides its mesh. Whatever the bytes are, a scene checks what becomes of it.
void pack(Packer& packer, const Declarations& declared);
Declarations unpack_declarations(Unpacker& unpacker);

/// What is said of a file: all but the generators.
void pack(Packer& packer, const MeshOptions& options);
MeshOptions unpack_options(Unpacker& unpacker);

}  // namespace chladni::mesh
