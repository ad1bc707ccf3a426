#include "sound/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "common/error.hpp"
#include "sound/radiation.hpp"
#include "squeal/cycle_harmonics.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/limit_cycle_direct.hpp"
#include "squeal/stability.hpp"
#include "squeal/stability_search.hpp"

namespace chladni::sound {
namespace {

using Eigen::Index;

/// Harmonics of a mode on its ring below this part of the largest are noise of the mesh; of the
/// radiated power they are the square of it.
constexpr double noise = 2e-3;

/// Circumferential harmonics that the modes of the disc have.
std::vector<int> harmonics_of(const squeal::Disc& disc)
{
  const squeal::Harmonics& W = disc.rings.front().W;
  const Eigen::ArrayXXd amplitude = (W.cosine.cwiseAbs2() + W.sine.cwiseAbs2()).cwiseSqrt().array();
  std::vector<int> harmonics;
  for (Index n = 0; n < amplitude.rows(); ++n) {
    const auto part = amplitude.row(n) / amplitude.colwise().maxCoeff();
    if ((part > noise).any()) harmonics.push_back(static_cast<int>(n));
  }
  return harmonics;
}

std::vector<int> modes_of(const squeal::Disc& disc)
{
  std::vector<int> modes;
  for (const int number : disc.mode_numbers) modes.push_back(number - 1);
  return modes;
}

/// What all steps of a study need.
struct Stage {
  squeal::Disc disc;
  ThickBody body;
  SurfaceMotion motion;
};

Stage make_stage(const Setting& setting)
{
  squeal::Disc disc = squeal::make_disc(setting.body, setting.squeal.ring, setting.squeal.modes);
  ThickBody body = thick_body(setting.sound.lines, setting.sound.hub, setting.sound.holes);
  SurfaceMotion motion(setting.body, body, modes_of(disc), harmonics_of(disc));
  return {std::move(disc), std::move(body), std::move(motion)};
}

Brake brake_at(const squeal::Disc& disc, const squeal::SquealOptions& options, double speed)
{
  const squeal::InertialDisc inertial = squeal::inertial_disc(disc);
  const squeal::StabilityProfile profile = squeal::stability_over_speed(inertial, options);
  Brake brake{.critical = squeal::critical_speed(profile),
              .stability = squeal::name_of(squeal::stability_of(profile)),
              .growth = squeal::least_stable_eigenvalue(inertial, options, speed).real(),
              .cycle = {}};
  if (brake.growth > 0.0) brake.cycle = squeal::limit_cycle_direct(disc, options, speed);
  return brake;
}

SoundResults with_radiation_of(const Setting& setting, const Stage& stage, double speed,
                               const StudyProgress& report)
{
  SoundResults results{.medium = setting.sound.air.medium,
                       .harmonics = stage.motion.harmonics(),
                       .residual = stage.motion.residual().maxCoeff(),
                       .radiation = {},
                       .feedback = {},
                       .vibration = {},
                       .tones = {},
                       .microphones = setting.sound.microphones,
                       .heard = {},
                       .directivity = {},
                       .loudness = {}};
  report("radiation", 0.0);
  const auto inertial = squeal::find_inertial_disc(stage.disc);
  const double squeal_omega =
      inertial ? squeal::least_stable_eigenvalue(*inertial, setting.squeal, speed).imag() : 0.0;
  results.radiation = radiation(setting.body, {stage.body, stage.motion, setting.sound.air},
                                modes_of(stage.disc), squeal_omega);
  if (inertial) {
    report("feedback", 0.0);
    const squeal::Disc damped = squeal::with_radiation(stage.disc, results.radiation);
    results.feedback = {speed, brake_at(stage.disc, setting.squeal, speed),
                        brake_at(damped, setting.squeal, speed)};
  }
  return results;
}

/// "the limit cycle is missing", and how to get it.
[[noreturn]] void refuse_without_cycle(CycleChoice choice)
{
  const char* wanted = choice == CycleChoice::automatic   ? "limit-cycle\" or \"limit-cycle-direct"
                       : choice == CycleChoice::transient ? "limit-cycle"
                                                          : "limit-cycle-direct";
  throw Error(
      fmt::format("sound: the results of squeal hold no limit cycle that could sound; ask for the "
                  "analysis \"{}\" in [squeal] and run `squeal run` again",
                  wanted));
}

/// The periodic motion that sounds: its fundamental.
Vibration chosen_vibration(const squeal::SquealResults& results, CycleChoice choice)
{
  const auto fundamental = [](const auto& cycle) {
    if (cycle.amplitude.size() == 0)
      throw Error(
          "sound: the limit cycle has no amplitudes in the standing frame, because its disc is not "
          "axisymmetric: such a disc sounds at more frequencies than one");
    Vibration v{.speed = cycle.speed,
                .omega = 2.0 * std::numbers::pi * cycle.frequency_Hz,
                .modes = {},
                .harmonics = cycle.amplitude};
    for (const int number : cycle.mode_numbers) v.modes.push_back(number - 1);
    return v;
  };
  // What a transient has not settled at is no limit cycle where one was found as such.
  const bool better = choice == CycleChoice::automatic && results.limit_cycle &&
                      !results.limit_cycle->settled && results.limit_cycle_direct;
  if (results.limit_cycle && choice != CycleChoice::direct && !better)
    return fundamental(*results.limit_cycle);
  if (results.limit_cycle_direct && choice != CycleChoice::transient)
    return fundamental(*results.limit_cycle_direct);
  refuse_without_cycle(choice);
}

/// With the higher harmonics of the same motion found as a periodic one, whose fundamental differs
/// from that of a transient by what the transient has not settled yet.
Vibration with_harmonics(Vibration v, const squeal::Disc& disc,
                         const squeal::SquealOptions& options)
{
  const auto cycle = squeal::limit_cycle_direct(disc, options, v.speed);
  Eigen::MatrixXcd all = squeal::cycle_harmonics(disc, options, cycle);
  all.col(0) = v.harmonics.col(0);
  v.harmonics = std::move(all);
  return v;
}

/// A limit cycle is a motion of the modes: far above them it is of another body. What the air has
/// to resolve grows with its frequency.
constexpr double largest_ratio = 10.0;

void check_modes(const Vibration& vibration, const squeal::Disc& disc)
{
  if (vibration.modes != modes_of(disc))
    throw Error(
        "sound: the limit cycle consists of other modes than use_modes of [squeal] says now; run "
        "`squeal run` again");
  const double highest = disc.omega.maxCoeff();
  if (vibration.omega > 0.0 && vibration.omega <= largest_ratio * highest) return;
  throw Error(fmt::format(
      "sound: the limit cycle has {:.6g} Hz, and the modes of the body reach {:.6g} Hz: it is of "
      "another body; run `squeal run` again",
      vibration.omega / (2.0 * std::numbers::pi), highest / (2.0 * std::numbers::pi)));
}

void check_microphones(const Outline& outline, const std::vector<Microphone>& microphones)
{
  for (const Microphone& microphone : microphones) {
    if (!contains(outline, microphone.x)) continue;
    throw Error(fmt::format(
        "sound: the microphone \"{}\" at ({:.6g}, {:.6g}, {:.6g}) m is inside the body; move it "
        "into the air",
        microphone.name, microphone.x[0], microphone.x[1], microphone.x[2]));
  }
}

Loudness loudness_at(const Setting& setting, const Stage& stage, const squeal::Disc& disc,
                     double speed)
{
  Loudness loudness{.speed = speed,
                    .damped = false,
                    .frequency_Hz = 0.0,
                    .pad_velocity = 0.0,
                    .power = 0.0,
                    .rms_dB = {}};
  const squeal::InertialDisc inertial = squeal::inertial_disc(disc);
  if (!(squeal::least_stable_eigenvalue(inertial, setting.squeal, speed).real() > 0.0))
    return loudness;
  const auto cycle = squeal::limit_cycle_direct(disc, setting.squeal, speed);
  const Vibration vibration{.speed = speed,
                            .omega = 2.0 * std::numbers::pi * cycle.frequency_Hz,
                            .modes = modes_of(disc),
                            .harmonics = squeal::cycle_harmonics(disc, setting.squeal, cycle)};
  const auto sounding =
      tones({stage.body, stage.motion, setting.sound.air}, vibration, setting.sound.harmonics);
  loudness.frequency_Hz = cycle.frequency_Hz;
  loudness.pad_velocity = cycle.pad_velocity;
  for (const Tone& tone : sounding) loudness.power += near_power(tone);
  for (const Heard& heard : listen(sounding, setting.sound.microphones))
    loudness.rms_dB.push_back(heard.rms_dB);
  return loudness;
}

std::vector<Loudness> loudness_over_speeds(const Setting& setting, const Stage& stage,
                                           const squeal::Radiation& radiation,
                                           const StudyProgress& report)
{
  std::vector<Loudness> all;
  const squeal::Disc damped = squeal::with_radiation(stage.disc, radiation);
  const auto n = 2.0 * double(setting.sound.speeds.size());
  for (const double speed : setting.sound.speeds) {
    for (const bool with : {false, true}) {
      report("levels over the speed", double(all.size()) / n);
      all.push_back(loudness_at(setting, stage, with ? damped : stage.disc, speed));
      all.back().damped = with;
    }
  }
  return all;
}

StudyProgress silent_if_empty(const StudyProgress& progress)
{
  return progress ? progress : [](const std::string&, double) {};
}

}  // namespace

SoundResults radiation_study(const Setting& setting, double speed, const StudyProgress& progress)
{
  return with_radiation_of(setting, make_stage(setting), speed, silent_if_empty(progress));
}

SoundResults sound_study(const Setting& setting, const squeal::SquealResults& squeal_results,
                         const StudyProgress& progress)
{
  const StudyProgress report = silent_if_empty(progress);
  Vibration vibration = chosen_vibration(squeal_results, setting.sound.cycle);
  const Stage stage = make_stage(setting);
  check_modes(vibration, stage.disc);
  check_microphones(stage.body.outline, setting.sound.microphones);
  SoundResults results = with_radiation_of(setting, stage, vibration.speed, report);
  report("sound", 0.0);
  if (setting.sound.harmonics > 1) {
    const squeal::Disc disc =
        setting.damped ? squeal::with_radiation(stage.disc, results.radiation) : stage.disc;
    vibration = with_harmonics(std::move(vibration), disc, setting.squeal);
  }
  results.vibration = vibration;
  results.tones =
      tones({stage.body, stage.motion, setting.sound.air}, vibration, setting.sound.harmonics);
  results.heard = listen(results.tones, setting.sound.microphones);
  results.directivity = directivity(results.tones);
  results.loudness = loudness_over_speeds(setting, stage, results.radiation, report);
  return results;
}

}  // namespace chladni::sound
