#pragma once

#include <optional>

#include "common/packing.hpp"
#include "confinement/confine.hpp"
#include "mesh/mesh_options.hpp"

/// What chladni-mesher is asked for.
namespace chladni::mesh {

/// Writes the options that decide on the mesh of a file, as it is read, or of a generator.
void pack(Packer& packer, const MeshOptions& options);
MeshOptions unpack_options(Unpacker& unpacker);

/// Writes the limits of a process that reads a file.
void pack(Packer& packer, const std::optional<confinement::Limits>& limits);
std::optional<confinement::Limits> unpack_limits(Unpacker& unpacker);

}  // namespace chladni::mesh
