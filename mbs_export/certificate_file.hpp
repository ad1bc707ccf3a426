#pragma once

#include "mbs_export/certificate.hpp"
#include "mbs_export/hdf5.hpp"

/// The group `certificate` of the reduced file (docs/file_formats.md).
namespace chladni::mbs_export {

/// Nothing where the certificate is empty.
void write_certificate(hdf5::Writer& file, const Certificate& certificate);

/// An empty one where the file has none.
/// @throws chladni::Error as hdf5::Reader.
Certificate read_certificate(const hdf5::Reader& file);

}  // namespace chladni::mbs_export
