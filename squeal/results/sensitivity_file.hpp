#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Write and read the group /mode_sensitivity of a result file.
void write_sensitivity(files::Writer& file, const ModeSensitivity& sensitivity);
ModeSensitivity read_sensitivity(const files::Reader& file);

}  // namespace chladni::squeal
