#pragma once

#include <optional>

#include "files/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

/// The group `selection` of the body file (docs/reference/file_formats.md).
namespace chladni::mbs_export {

void write_selection(files::Writer& file, const SelectionTable& table);

/// Reads the group; absent if no tolerance chose the modes.
/// @throws chladni::Error as files::Reader.
std::optional<SelectionTable> read_selection(const files::Reader& file);

}  // namespace chladni::mbs_export
