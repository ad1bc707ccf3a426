#pragma once

#include <cstddef>
#include <string>

namespace chladni::files {

/// Writes into the superblock of an HDF5 file (versions 0 and 1, libhdf5's default) that HDF5
/// begins at byte `start`, and shifts its end address likewise. libhdf5 finds the beginning itself;
/// other readers trust the superblock. Newer superblocks are left unchanged.
/// @return false if it could not be read or written
bool place_superblock(const std::string& path, std::size_t start);

}  // namespace chladni::files
