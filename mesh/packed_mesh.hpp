#pragma once

#include "common/packing.hpp"
#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Writes a mesh as bytes.
void pack(Packer& packer, const Mesh& mesh);

/// Reads a mesh that another process of this program packed. The sizes, indices and numbers of the
/// result are consistent, whatever the bytes are.
/// @throws chladni::Error when the bytes are not such a mesh.
Mesh unpack_mesh(Unpacker& unpacker);

/// Writes the declarations of a deck as bytes. They are not checked on unpacking, but by the scene
/// made from them.
void pack(Packer& packer, const Declarations& declared);
Declarations unpack_declarations(Unpacker& unpacker);

}  // namespace chladni::mesh
