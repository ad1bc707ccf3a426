#pragma once

#include <string>
#include <vector>

#include "report/json.hpp"
#include "sound/study.hpp"

namespace chladni::report {

/// What `chladni sound` found, as tables for people.
std::string describe_sound(const sound::SoundResults& results);

/// Members `tones`, `microphones`, `power_W`, `radiation`, `feedback`, `loudness`.
std::vector<Json::Member> sound_json(const sound::SoundResults& results);

}  // namespace chladni::report
