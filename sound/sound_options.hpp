#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sound/air_plan.hpp"
#include "sound/outline.hpp"

namespace chladni::sound {

/// A point where the sound is computed.
struct Microphone {
  std::string name;
  Eigen::Vector3d x;  ///< position in the scene's frame, which does not rotate, m
};

/// A sound file of the pressure at a microphone.
struct WavCase {
  std::string microphone;
  int rate_Hz;
  double duration;  ///< s
};

/// The limit cycle of a squeal study whose sound is computed.
enum class CycleChoice {
  /// The end of a transient that has settled, else the direct limit cycle, else the end of the
  /// transient.
  automatic,
  transient,
  direct
};

/// The options of the scene's [sound].
struct SoundOptions {
  AirOptions air = {};
  std::vector<MidLine> lines;  ///< middle surface of the body in the meridian plane
  Hub hub = Hub::closed;
  std::vector<Holes> holes = {};
  std::vector<Microphone> microphones = {};
  CycleChoice cycle = CycleChoice::automatic;
  int harmonics = 5;                ///< number of harmonics of the motion whose sound is computed
  std::vector<double> speeds = {};  ///< speeds of further limit cycles, rad/s
  std::optional<WavCase> wav = {};
};

}  // namespace chladni::sound
