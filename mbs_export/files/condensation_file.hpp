#pragma once

#include <optional>

#include "files/hdf5.hpp"
#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export::file_parts {

/// Writes the group `condensation`; nothing if there is none.
void write_condensation(files::Writer& file, const std::optional<Condensation>& condensation);

/// Reads the group `condensation`; absent if the file has none.
/// @throws chladni::Error naming the dataset and what was expected.
std::optional<Condensation> read_condensation(const files::Reader& file);

}  // namespace chladni::mbs_export::file_parts
