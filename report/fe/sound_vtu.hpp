#pragma once

#include <string>
#include <vector>

#include "sound/tone.hpp"

namespace chladni::report {

/// The sound field of the first tone around the body as the text of a .vtu file: real part,
/// imaginary part, amplitude and level of the pressure.
std::string sound_vtu(const std::vector<sound::Tone>& tones);

}  // namespace chladni::report
