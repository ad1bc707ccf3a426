#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export::file_parts {

/// The group `provenance` of each file that is made of a scene.
void write_provenance(files::Writer& file, const Provenance& provenance);
/// @throws chladni::Error naming file and dataset for what is missing or of the wrong kind.
Provenance read_provenance(const files::Reader& file);
Provenance read_provenance(const std::filesystem::path& file);

}  // namespace chladni::mbs_export::file_parts
