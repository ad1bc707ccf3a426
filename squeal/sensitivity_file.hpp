#pragma once

#include "mbs_export/hdf5.hpp"
#include "squeal/results.hpp"

namespace chladni::squeal {

/// The group `mode_sensitivity` of a result file.
void write_sensitivity(mbs_export::hdf5::Writer& file, const ModeSensitivity& sensitivity);
ModeSensitivity read_sensitivity(const mbs_export::hdf5::Reader& file);

}  // namespace chladni::squeal
