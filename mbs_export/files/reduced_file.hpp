#pragma once

#include <string>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The attribute `format` of such a file.
inline constexpr auto reduced_format = "chladni-reduced";

/// Writes *.reduced.h5, format "chladni-reduced" version 1 (docs/reference/file_formats.md), in
/// full precision. The file appears complete or not at all.
/// @throws chladni::Error when the file cannot be written.
void write_reduced(const std::string& path, const ReducedSystem& reduced);

/// Reads what `write_reduced` wrote, bit by bit, and any file that keeps to the format.
/// @throws chladni::Error naming the file, the dataset and what was expected: another format or
///         version, a missing dataset, a wrong type or shape, a value that is not finite, an index
///         out of range, K or M unsymmetric beyond round-off.
ReducedSystem read_reduced(const std::string& path);
ReducedSystem read_reduced(const files::Reader& file);

}  // namespace chladni::mbs_export
