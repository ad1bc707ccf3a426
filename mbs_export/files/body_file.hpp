#pragma once

#include <string>

#include "files/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

/// The value of the attribute `format` of a body file.
inline constexpr auto body_format = "chladni-body";

/// Writes *.body.h5, format "chladni-body" version 1 (docs/reference/file_formats.md), in full
/// precision, with the circumferential Fourier coefficients of each contact ring for other
/// programs. The file appears completely or not at all.
/// @throws chladni::Error when the file cannot be written.
void write_body(const std::string& path, const ModalBody& body);

/// Reads a body file. A body that `write_body` wrote is restored bit by bit.
/// @throws chladni::Error naming the file, the dataset and what was expected.
ModalBody read_body(const std::string& path);
ModalBody read_body(const files::Reader& file);

}  // namespace chladni::mbs_export
