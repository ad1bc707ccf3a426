#pragma once

#include <string>

#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::formats {

/// A body as MAT-file of version 5, for MATLAB, Octave and scipy.io.loadmat: the struct `body` with
/// the fields of docs/reference/file_formats.md, in SI. Indices count from 1.
/// @throws chladni::Error when it is too large for the format.
std::string matlab_body(const ModalBody& body);

}  // namespace chladni::mbs_export::formats
