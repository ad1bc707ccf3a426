#pragma once

#include <filesystem>
#include <string>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::squeal {

/// Attribute `format` of a sweep file.
inline constexpr auto sweep_format = "chladni-squeal-sweep";

/// Writes a file `*.sweep.h5` as a whole or not at all. Some variants may still be to do.
/// @throws chladni::Error when the file cannot be written.
void write_sweep(const std::filesystem::path& file, const SweepTable& sweep,
                 const mbs_export::Provenance& provenance);

/// Reads a file of `write_sweep`.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
SweepTable read_sweep(const files::Reader& file);

/// The table as comma-separated values: number of the variant, keys, columns, `failure`. A cell is
/// empty when its value is unknown; numbers read back as the same double.
std::string csv_of(const SweepTable& sweep);

}  // namespace chladni::squeal
