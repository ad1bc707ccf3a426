#pragma once

#include <string>

#include "mesh/exchange/exchange_mesh.hpp"

namespace chladni::mesh {

/// The one mesh of a MED file (version 3 or 4), nodes, elements of order 1 and 2, and the groups of
/// its families; fields are left out with a note. Reads HDF5 without code or values from elsewhere,
/// and is not safe from what libhdf5 does with damaged metadata: a stranger's file is read in a
/// process of its own (mesh_reader.hpp).
/// @param bytes  of the file
/// @throws chladni::Error naming the object of the file that is wrong or not known.
ExchangeMesh med_mesh(const std::string& bytes);

}  // namespace chladni::mesh
