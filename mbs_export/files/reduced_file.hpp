#pragma once

#include <string>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The value of the attribute `format` of a reduced file.
inline constexpr auto reduced_format = "chladni-reduced";

/// Writes *.reduced.h5, format "chladni-reduced" version 1 (docs/reference/file_formats.md), in
/// full precision. The file appears completely or not at all.
/// @throws chladni::Error when the file cannot be written.
void write_reduced(const std::string& path, const ReducedSystem& reduced);

/// Reads a reduced file. A system that `write_reduced` wrote is restored bit by bit.
/// @throws chladni::Error naming the file, the dataset and what was expected: another format or
///         version, a missing dataset, a wrong type or shape, a value that is not finite, an index
///         out of range, K or M unsymmetric beyond round-off.
ReducedSystem read_reduced(const std::string& path);
ReducedSystem read_reduced(const files::Reader& file);

}  // namespace chladni::mbs_export
