#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The attribute `format` of such a file.
inline constexpr auto results_format = "chladni-squeal";

/// Writes `*.squeal.h5`: written to a temporary name, flushed and renamed.
/// @throws chladni::Error when the file cannot be written.
void write_results(const std::filesystem::path& file, const SquealResults& results,
                   const mbs_export::Provenance& provenance);

/// Reads what `write_results` wrote.
/// @throws chladni::Error naming file and dataset for anything missing, of wrong size or not
/// finite.
SquealResults read_results(const std::filesystem::path& path);
SquealResults read_results(const files::Reader& file);

}  // namespace chladni::squeal
