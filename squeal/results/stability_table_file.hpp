#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::squeal {

/// Writes the group `stability`; see docs/reference/file_formats.md.
void write_stability_table(files::Writer& file, const StabilityTable& table);

/// @throws chladni::Error naming file and dataset for anything missing, of wrong size or not
/// finite.
StabilityTable read_stability_table(const files::Reader& file);

}  // namespace chladni::squeal
