#pragma once

#include <filesystem>
#include <string>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::squeal {

/// The attribute `format` of such a file.
inline constexpr auto sweep_format = "chladni-squeal-sweep";

/// Writes `*.sweep.h5` as a whole or not at all; also one of which variants are still to do.
/// @throws chladni::Error when the file cannot be written.
void write_sweep(const std::filesystem::path& file, const SweepTable& sweep,
                 const mbs_export::Provenance& provenance);

/// Reads what `write_sweep` wrote.
/// @throws chladni::Error naming file and dataset for anything missing, of wrong size or not
///         finite.
SweepTable read_sweep(const files::Reader& file);

/// The table as comma-separated values: the number of the variant, the keys, the columns,
/// `failure`. A cell is empty where nothing is known; numbers read back as the same double.
std::string csv_of(const SweepTable& sweep);

}  // namespace chladni::squeal
