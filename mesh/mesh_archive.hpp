#pragma once

#include <optional>

#include "common/confinement/sandbox.hpp"
#include "common/packing.hpp"
#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

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

/// What chladni-mesher is asked for.

namespace chladni::mesh {

/// Writes the options that decide on the mesh of a file, as it is read, or of a generator.
void pack(Packer& packer, const MeshOptions& options);
MeshOptions unpack_options(Unpacker& unpacker);

/// Writes the limits of a process that reads a file.
void pack(Packer& packer, const std::optional<confinement::Limits>& limits);
std::optional<confinement::Limits> unpack_limits(Unpacker& unpacker);

}  // namespace chladni::mesh
