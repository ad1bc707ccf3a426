#pragma once

#include <string>

namespace chladni::fuzz {

/// The golden files of what `squeal run` and `chladni sound` leave.
inline constexpr auto golden_results = CHLADNI_SOURCE_DIR "/tests/data/version_1.squeal.h5";
inline constexpr auto golden_radiation = CHLADNI_SOURCE_DIR "/tests/data/version_1.radiation.h5";

/// All that programs do with a *.squeal.h5: the tables of `squeal info`, the numbers and motions of
/// `squeal report` beside a body of three modes.
void read_results(const std::string& path);

/// What `squeal run` does with a *.radiation.h5: a disc of two modes gets its damping.
void read_radiation(const std::string& path);

}  // namespace chladni::fuzz
