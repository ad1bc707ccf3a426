#pragma once

#include <string>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// Reads the single mesh of a MED file (version 3 or 4): nodes, elements of order 1 and 2, and the
/// groups of its families. Fields are left out with a note. HDF5 plugins and external files are not
/// used. Damaged metadata can still make libhdf5 fail, so a stranger's file must be read in a
/// process of its own (mesher.hpp).
/// @param bytes  contents of the file
/// @throws chladni::Error naming the object of the file that is wrong or unknown.
ExchangeMesh med_mesh(const std::string& bytes);

}  // namespace chladni::mesh
