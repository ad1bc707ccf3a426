#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Attribute `format` of a result file.
inline constexpr auto results_format = "chladni-squeal";

/// Writes a file `*.squeal.h5`, under a temporary name that is flushed and then renamed.
/// @throws chladni::Error when the file cannot be written.
void write_results(const std::filesystem::path& file, const SquealResults& results,
                   const mbs_export::Provenance& provenance);

/// Reads a file of `write_results`.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
SquealResults read_results(const std::filesystem::path& path);
SquealResults read_results(const files::Reader& file);

}  // namespace chladni::squeal
