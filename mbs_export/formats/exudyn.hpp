#pragma once

#include <string>

#include "mbs_export/formats/floating_body.hpp"

namespace chladni::mbs_export::formats {

/// Writes a body as the dictionary of Exudyn's ObjectFFRFreducedOrderInterface, in the HDF5 that
/// its LoadDictFromHDF5 reads: nodes are the attachment nodes, then those of the picture, of which
/// the triangles are the surface. Its products of shapes are the mass integrals of the FE model,
/// which the mid-surface nodes of shells could not give.
/// @throws chladni::Error when the body has no mass integrals or no elastic mode, or the file
///         cannot be written.
void write_exudyn(const std::string& path, const FloatingBody& floating);

}  // namespace chladni::mbs_export::formats
