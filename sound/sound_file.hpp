#pragma once

#include <filesystem>

#include "mbs_export/reduced_system.hpp"
#include "sound/study.hpp"

namespace chladni::sound {

/// Writes the results to a file `*.sound.h5`, under a temporary name that is flushed and then
/// renamed.
/// @throws chladni::Error when the file cannot be written.
void write_sound(const std::filesystem::path& file, const SoundResults& results,
                 const mbs_export::Provenance& provenance);

}  // namespace chladni::sound
