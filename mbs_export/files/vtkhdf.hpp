#pragma once

#include "files/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// The group /VTKHDF (version 1.0, UnstructuredGrid), by which ParaView shows the surface of a body
/// with each of its modes as a vector field, "mode 03, 812.5 Hz". The values are those of
/// `picture`, as views: no second copy. Nothing for a body without a picture.
void write_vtkhdf(files::Writer& file, const ModalBody& body);

}  // namespace chladni::mbs_export
