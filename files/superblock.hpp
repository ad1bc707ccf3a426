#pragma once

#include <cstddef>
#include <string>

namespace chladni::files {

/// Writes into the superblock of an HDF5 file (versions 0 and 1, as libhdf5 makes them by default)
/// that HDF5 begins at byte `start`, and ends as much later as before. libhdf5 finds out where it
/// begins; other readers believe what stands there. Newer superblocks are left as they are.
/// @return whether it could be read and written
bool place_superblock(const std::string& path, std::size_t start);

}  // namespace chladni::files
