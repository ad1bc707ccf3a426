#pragma once

#include <string>

#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

/// Writes a body as the dictionary of Exudyn's ObjectFFRFreducedOrderInterface, in the HDF5 layout
/// that its LoadDictFromHDF5 reads. Nodes are the attachment nodes, then those of the picture,
/// whose triangles are the surface. Its products of shapes are the mass integrals of the FE model,
/// which cannot be computed from the mid-surface nodes of shells.
/// @throws chladni::Error when the body has no mass integrals or no elastic mode, or the file
///         cannot be written.
void write_exudyn(const std::string& path, const FloatingBody& floating);

}  // namespace chladni::mbs_export::formats
