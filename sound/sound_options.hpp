#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sound/air_plan.hpp"
#include "sound/thick_body.hpp"

namespace chladni::sound {

/// Where the sound is listened to.
struct Microphone {
  std::string name;
  Eigen::Vector3d x;  ///< m, in the frame of the scene, which does not rotate
};

/// The pressure at a microphone as a file.
struct WavCase {
  std::string microphone;
  int rate_Hz;
  double duration;  ///< s
};

/// Which limit cycle of a squeal study sounds.
enum class CycleChoice {
  automatic,  ///< that of a transient which has settled, else the direct one, else the end
              ///< of the transient
  transient,
  direct
};

/// The scene's [sound].
struct SoundOptions {
  AirOptions air = {};
  std::vector<MidLine> lines;  ///< middle surface of the body
  Hub hub = Hub::closed;
  std::vector<Holes> holes = {};
  std::vector<Microphone> microphones = {};
  CycleChoice cycle = CycleChoice::automatic;
  int harmonics = 5;                ///< multiples of the frequency that are looked at
  std::vector<double> speeds = {};  ///< rad/s, of further limit cycles
  std::optional<WavCase> wav = {};
};

}  // namespace chladni::sound
