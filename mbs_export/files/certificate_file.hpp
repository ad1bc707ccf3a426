#pragma once

#include "files/hdf5.hpp"
#include "mbs_export/certificate.hpp"

/// The group `certificate` of the reduced file (docs/reference/file_formats.md).
namespace chladni::mbs_export {

/// Writes the group; writes nothing if the certificate is empty.
void write_certificate(files::Writer& file, const Certificate& certificate);

/// Reads the group; the certificate is empty if the file has none.
/// @throws chladni::Error as files::Reader.
Certificate read_certificate(const files::Reader& file);

}  // namespace chladni::mbs_export
