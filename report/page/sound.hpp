#pragma once

#include <filesystem>

#include "files/hdf5.hpp"
#include "report/json.hpp"

namespace chladni::report {

/// What the page shows and plays of `chladni sound`: tones, levels at microphones, directivity,
/// levels over the speed, what radiation does to the squeal. A WAV file of more than 4 MB is named,
/// but not put into the page.
/// @param wav  NAME.sound.wav; need not be there
/// @throws chladni::Error when the file is damaged.
Json sound_page(const files::Reader& file, const std::filesystem::path& wav);

}  // namespace chladni::report
