#pragma once

#include <filesystem>

#include "mbs_export/reduced_system.hpp"
#include "sound/study.hpp"

namespace chladni::sound {

/// Writes `*.sound.h5`: written to a temporary name, flushed and renamed.
/// @throws chladni::Error when the file cannot be written.
void write_sound(const std::filesystem::path& file, const SoundResults& results,
                 const mbs_export::Provenance& provenance);

}  // namespace chladni::sound
