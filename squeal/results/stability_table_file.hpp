#pragma once

#include "files/hdf5.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::squeal {

/// Writes the group /stability of a result file; see docs/reference/file_formats.md.
void write_stability_table(files::Writer& file, const StabilityTable& table);

/// Reads the group /stability of a result file.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
StabilityTable read_stability_table(const files::Reader& file);

}  // namespace chladni::squeal
