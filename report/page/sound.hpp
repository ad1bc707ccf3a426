#pragma once

#include <filesystem>
#include <string>

#include "common/files/hdf5.hpp"
#include "report/json.hpp"

namespace chladni::report {

/// The pressure at a microphone as sound.
struct SoundWav {
  std::filesystem::path file;  ///< need not be there
  std::string microphone;
};

/// What the page shows and plays of `chladni sound`: tones, levels at microphones, directivity,
/// levels over the speed, what radiation does to the squeal. A WAV file of more than 4 MB is named,
/// but not put into the page.
/// @throws chladni::Error when the file is damaged.
Json sound_page(const files::Reader& file, const SoundWav& wav);

}  // namespace chladni::report
