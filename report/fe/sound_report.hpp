#pragma once

#include <string>
#include <vector>

#include "report/json.hpp"
#include "sound/study.hpp"

namespace chladni::report {

/// The results of `chladni sound` as tables for the terminal.
std::string describe_sound(const sound::SoundResults& results);

/// JSON members `tones`, `microphones`, `power_W`, `radiation`, `feedback`, `loudness`.
std::vector<Json::Member> sound_json(const sound::SoundResults& results);

}  // namespace chladni::report
