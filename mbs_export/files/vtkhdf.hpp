#pragma once

#include "files/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// Writes the group /VTKHDF (version 1.0, UnstructuredGrid), with which ParaView shows the surface
/// of a body and each of its modes as a vector field, "mode 03, 812.5 Hz". The values are views on
/// those of `picture` and are not stored twice. Nothing is written for a body without a picture.
void write_vtkhdf(files::Writer& file, const ModalBody& body);

}  // namespace chladni::mbs_export
