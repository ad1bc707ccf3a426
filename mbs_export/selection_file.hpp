#pragma once

#include <optional>

#include "mbs_export/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

/// The group `selection` of the body file (docs/file_formats.md).
namespace chladni::mbs_export {

void write_selection(hdf5::Writer& file, const SelectionTable& table);

/// Nothing where no tolerance chose the modes.
/// @throws chladni::Error as hdf5::Reader.
std::optional<SelectionTable> read_selection(const hdf5::Reader& file);

}  // namespace chladni::mbs_export
