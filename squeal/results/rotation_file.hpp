#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// Writes the group /rotation_stability of a result file; see docs/reference/file_formats.md.
void write_rotation_stability(files::Writer& file, const RotationStability& stability);

/// Reads the group /rotation_stability, also from files of earlier versions, which have neither
/// method nor exponents.
RotationStability read_rotation_stability(const files::Reader& file);

}  // namespace chladni::squeal
