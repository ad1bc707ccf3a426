#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sound/levels.hpp"
#include "squeal/brake/radiation.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::sound {

/// A disc between its pads, without or with the damping by its sound.
struct Brake {
  std::optional<squeal::CriticalSpeed> critical;  ///< absent when there is none in the range
  std::string stability;  ///< over the range of speeds, in the words of squeal::name_of(Stability)
  double growth;          ///< largest growth rate at the speed of the study, 1/s
  std::optional<squeal::DirectLimitCycle> cycle;  ///< absent when the disc is stable there
};

/// What radiation does to the squeal.
struct Feedback {
  double speed;  ///< rad/s
  Brake without, with;
};

/// How loud the limit cycle is at one speed.
struct Loudness {
  double speed;                ///< rad/s
  bool damped;                 ///< by its radiation
  double frequency_Hz;         ///< 0 when there is no limit cycle
  double pad_velocity;         ///< m/s
  double power;                ///< W
  std::vector<double> rms_dB;  ///< of each microphone; empty when there is no limit cycle
};

/// What `chladni sound` finds.
struct SoundResults {
  Medium medium;
  std::vector<int> harmonics;  ///< circumferential ones
  double residual;             ///< of the surface's motion; the largest of SurfaceMotion::residual
  int inner_nodes = 0;         ///< of the body's picture, between the middle lines; they are silent
  squeal::Radiation radiation;
  std::optional<Feedback> feedback;  ///< absent when the disc is not axisymmetric; see `notes`
  std::optional<Vibration> vibration;
  std::vector<Tone> tones;
  std::vector<Accuracy> accuracy;  ///< [n_tones]
  std::vector<Microphone> microphones;
  std::vector<Heard> heard;
  std::optional<Directivity> directivity;
  std::vector<Loudness> loudness;
  std::vector<std::string> notes = {};  ///< what was left out and why, one sentence each
};

/// A body with the brake around it.
struct Setting {
  const mbs_export::ModalBody& body;
  const squeal::SquealOptions& squeal;
  const SoundOptions& sound;
  bool damped = false;  ///< the limit cycle was found with the damping by radiation
};

/// Called with the name of the step under way and the part of it that is done, 0 to 1.
using StudyProgress = std::function<void(const std::string& step, double part)>;

/// What is told while a study runs.
struct StudyListener {
  StudyProgress progress = {};
  /// Called with what there is so far when the radiation is known, and when the tones are known but
  /// not yet the levels at further speeds: whoever writes it keeps it should the rest not end.
  std::function<void(const SoundResults&)> found = {};
};

/// The speed at which the feedback is looked at when no limit cycle tells one, rad/s.
double speed_of(const squeal::SquealOptions& options);

/// The envelope of the transient, when that is what led to the limit cycle; else nothing.
Onset onset_of(const squeal::SquealResults& results, CycleChoice choice);

/// The damping of the modes that the brake uses, and what it does to the squeal at `speed`, rad/s.
/// @throws chladni::Error from make_stage and plan_air, before anything is solved.
SoundResults radiation_study(const Setting& setting, double speed,
                             const StudyListener& listener = {});

/// The same, and the sound of the limit cycle in `squeal_results`.
/// @throws chladni::Error when there is no limit cycle, or one of other modes; when a microphone is
///         inside the body; from make_stage and plan_air: all before anything is solved, unless the
///         brake is damped by its sound, where the harmonics follow from the radiation.
SoundResults sound_study(const Setting& setting, const squeal::SquealResults& squeal_results,
                         const StudyListener& listener = {});

}  // namespace chladni::sound
