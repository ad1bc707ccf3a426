#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::file_parts {

/// Writes the group `provenance`, which each file made from a scene has.
void write_provenance(files::Writer& file, const Provenance& provenance);
/// Reads the group `provenance`.
/// @throws chladni::Error naming file and dataset for what is missing or of the wrong kind.
Provenance read_provenance(const files::Reader& file);
Provenance read_provenance(const std::filesystem::path& file);

}  // namespace chladni::mbs_export::file_parts
