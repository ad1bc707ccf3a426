#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sound/levels.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::sound {

/// Squeal of a disc between its pads, without or with radiation damping.
struct Brake {
  /// Absent when there is none in the range of speeds.
  std::optional<squeal::CriticalSpeed> critical;
  std::string stability;  ///< stability over the range of speeds, as squeal::name_of(Stability)
  double growth;          ///< largest growth rate at the speed of the study, 1/s
  std::optional<squeal::DirectLimitCycle> cycle;  ///< absent when the disc is stable at that speed
};

/// Effect of the radiation damping on the squeal.
struct Feedback {
  double speed;  ///< speed of the study, rad/s
  Brake without, with;
};

/// Sound of the limit cycle at one speed.
struct Loudness {
  double speed;                ///< rad/s
  bool damped;                 ///< with radiation damping
  double frequency_Hz;         ///< 0 when there is no limit cycle
  double pad_velocity;         ///< m/s
  double power;                ///< W
  std::vector<double> rms_dB;  ///< level at each microphone; empty when there is no limit cycle
};

/// The results of `chladni sound`.
struct SoundResults {
  Medium medium;
  std::vector<int> harmonics;  ///< circumferential harmonics
  double residual;             ///< largest component of SurfaceMotion::residual
  /// Nodes of the body's picture between the middle lines, which radiate no sound.
  int inner_nodes = 0;
  squeal::Radiation radiation;
  /// Absent when the disc is not axisymmetric; the reason is in `notes`.
  std::optional<Feedback> feedback;
  std::optional<Vibration> vibration;
  std::vector<Tone> tones;
  std::vector<Accuracy> accuracy;  ///< [n_tones] estimated errors
  std::vector<Microphone> microphones;
  std::vector<Heard> heard;
  std::optional<Directivity> directivity;
  std::vector<Loudness> loudness;
  std::vector<std::string> notes = {};  ///< what was left out and why, one sentence each
};

/// A body with its brake, as input of a sound study.
struct Setting {
  const mbs_export::ModalBody& body;
  const squeal::SquealOptions& squeal;
  const SoundOptions& sound;
  bool damped = false;  ///< the limit cycle was computed with radiation damping
};

/// Callback with the name of the current step and the fraction of it that is done, 0 to 1.
using StudyProgress = std::function<void(const std::string& step, double part)>;

/// Callbacks of a running study.
struct StudyListener {
  StudyProgress progress = {};
  /// Called with the results so far, once after the radiation is known and once after the tones are
  /// known, before the levels at further speeds. A caller that writes them keeps them if the rest
  /// fails.
  std::function<void(const SoundResults&)> found = {};
};

/// The speed of the study when no limit cycle defines it, rad/s.
double speed_of(const squeal::SquealOptions& options);

/// The envelope of the transient if the chosen limit cycle is its end; else empty.
Onset onset_of(const squeal::SquealResults& results, CycleChoice choice);

/// Computes the radiation damping of the modes that the brake uses, and its effect on the squeal.
/// @param speed  rad/s
/// @throws chladni::Error from make_stage and plan_air, before anything is solved.
SoundResults radiation_study(const Setting& setting, double speed,
                             const StudyListener& listener = {});

/// Computes the results of radiation_study and the sound of the limit cycle in `squeal_results`.
/// @throws chladni::Error when there is no limit cycle or one of other modes; when a microphone is
///         inside the body; from make_stage and plan_air. All are thrown before anything is solved,
///         except that a brake with radiation damping needs the radiation first, to compute the
///         harmonics.
SoundResults sound_study(const Setting& setting, const squeal::SquealResults& squeal_results,
                         const StudyListener& listener = {});

}  // namespace chladni::sound
