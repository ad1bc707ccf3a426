#include "sound/study.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "sound/radiation.hpp"
#include "sound/sound_options.hpp"
#include "sound/surface_motion.hpp"
#include "sound/tone.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/cycle/cycle_harmonics.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::sound {

using Eigen::Index;

namespace {

/// Disc, body, surface motion and air: what all steps of a sound study use.
struct Stage {
  squeal::Disc disc;
  ThickBody body;
  SurfaceMotion motion;
  AirOptions air;

  Source source() const { return {body, motion, air}; }
};

/// The disc's modes as 0-based numbers of the body's modes.
std::vector<int> modes_of(const squeal::Disc& disc);

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
Vibration vibration_in(const squeal::SquealResults& results, CycleChoice choice)
{
  const auto fundamental = [](const auto& cycle) {
    if (cycle.amplitude.size() == 0) {
      throw Error(
          "sound: the limit cycle has no amplitudes in the fixed frame, because its disc is not "
          "axisymmetric and radiates at several frequencies; compute the radiation of each mode "
          "with --radiation");
    }
    Vibration v{.speed = cycle.speed,
                .omega = 2.0 * std::numbers::pi * cycle.frequency_Hz,
                .modes = {},
                .harmonics = cycle.amplitude};
    for (const int number : cycle.mode_numbers) v.modes.push_back(number - 1);
    return v;
  };
  // What a transient has not settled at is no limit cycle where one was found as such.
  const bool better = choice == CycleChoice::automatic && squeal::has_unsettled_end(results) &&
                      results.limit_cycle_direct;
  if (results.limit_cycle && choice != CycleChoice::direct && !better)
    return fundamental(*results.limit_cycle);
  if (results.limit_cycle_direct && choice != CycleChoice::transient)
    return fundamental(*results.limit_cycle_direct);
  refuse_without_cycle(choice);
}

/// A limit cycle is a motion of the modes: far above them it is of another body. What the air has
/// to resolve grows with its frequency.
constexpr double largest_ratio = 10.0;

void check_modes(const Vibration& vibration, const squeal::Disc& disc)
{
  if (vibration.modes != modes_of(disc)) {
    throw Error(
        "sound: the limit cycle consists of other modes than use_modes of [squeal] says now; run "
        "`squeal run` again");
  }
  const double highest = disc.omega.maxCoeff();
  if (vibration.omega > 0.0 && vibration.omega <= largest_ratio * highest) return;
  throw Error(fmt::format(
      "sound: the limit cycle has {:.6g} Hz, and the modes of the body reach {:.6g} Hz: it is of "
      "another body; run `squeal run` again",
      vibration.omega / (2.0 * std::numbers::pi), highest / (2.0 * std::numbers::pi)));
}

std::vector<int> modes_of(const squeal::Disc& disc)
{
  std::vector<int> modes;
  for (const int number : disc.mode_numbers) modes.push_back(number - 1);
  return modes;
}

/// Prepares a sound study.
/// @throws chladni::Error from make_disc, thick_body and SurfaceMotion.
Stage make_stage(const mbs_export::ModalBody& body, const squeal::SquealOptions& squeal,
                 const SoundOptions& sound)
{
  squeal::Disc disc = squeal::make_disc(body, squeal::ring_choice(squeal), squeal.modes);
  squeal::refuse_aliases(disc, body);
  ThickBody thick = thick_body(sound.lines, sound.hub, sound.holes);
  SurfaceMotion motion(body, thick, modes_of(disc), harmonics_of(disc));
  return {std::move(disc), std::move(thick), std::move(motion), sound.air};
}

/// The periodic motion, with its fundamental harmonic only, whose sound is computed.
/// @throws chladni::Error when there is none, when it has no amplitudes in the fixed frame, when it
///         consists of other modes than those of the disc, and when its frequency is far above
///         them.
Vibration chosen_vibration(const squeal::SquealResults& results, CycleChoice choice,
                           const squeal::Disc& disc)
{
  Vibration vibration = vibration_in(results, choice);
  check_modes(vibration, disc);
  return vibration;
}

/// Checks the positions of the microphones.
/// @throws chladni::Error naming a microphone inside the body.
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

Brake brake_at(const squeal::Disc& disc, const squeal::SquealOptions& options, double speed)
{
  const squeal::FlexibleDisc flexible(disc, options);
  const squeal::StabilityProfile profile =
      squeal::stability_until_critical(squeal::state_matrix_at(flexible), options.study.speeds);
  Brake brake{.critical = squeal::critical_speed(profile),
              .stability = squeal::name_of(squeal::stability_of(profile)),
              .growth = squeal::least_stable_eigenvalue(flexible.state_matrix(speed)).real(),
              .cycle = {}};
  if (brake.growth > 0.0) brake.cycle = squeal::limit_cycle_direct(flexible, speed);
  return brake;
}

/// Why nothing can be said of the squeal with the damping by sound, if so.
std::optional<std::string> hindrance(const squeal::Disc& disc, const squeal::Radiation& radiation)
{
  if (const auto reason = squeal::asymmetry(disc))
    return fmt::format("the disc is not axisymmetric: {}", *reason);
  if (const auto reason = squeal::asymmetry(squeal::with_radiation(disc, radiation)))
    return fmt::format("with this damping the disc is not axisymmetric: {}", *reason);
  return std::nullopt;
}

/// Performs a step without which the other results hold; its error becomes a note.
void attempt(std::vector<std::string>& notes, const std::string& what,
             const std::function<void()>& step)
{
  try {
    step();
  } catch (const Error& error) {
    notes.push_back(fmt::format("left out: {}, because {}", what, error.what()));
  }
}

constexpr auto feedback_name = "what the sound does to the squeal";

SoundResults with_radiation_of(const Setting& setting, const Stage& stage, double speed,
                               const StudyListener& listener)
{
  SoundResults results{.medium = setting.sound.air.medium,
                       .harmonics = stage.motion.harmonics(),
                       .residual = stage.motion.residual().maxCoeff(),
                       .inner_nodes = stage.motion.inner_nodes(),
                       .radiation = {},
                       .feedback = {},
                       .vibration = {},
                       .tones = {},
                       .accuracy = {},
                       .microphones = setting.sound.microphones,
                       .heard = {},
                       .directivity = {},
                       .loudness = {}};
  if (results.inner_nodes > 0) {
    results.notes.push_back(
        fmt::format("{} of the {} nodes of the body lie between its middle lines, as vanes do, and "
                    "are taken to be silent",
                    results.inner_nodes, setting.body.picture.positions.rows()));
  }
  listener.progress("radiation", 0.0);
  const squeal::FlexibleDisc flexible(stage.disc, setting.squeal);
  const double squeal_omega =
      flexible.is_autonomous()
          ? squeal::least_stable_eigenvalue(flexible.state_matrix(speed)).imag()
          : 0.0;
  results.radiation =
      even_over_pairs(radiation(setting.body, stage.source(), modes_of(stage.disc), squeal_omega),
                      stage.disc, stage.body.outline);
  listener.found(results);
  listener.progress("feedback", 0.0);
  attempt(results.notes, feedback_name, [&] {
    if (const auto reason = hindrance(stage.disc, results.radiation)) throw Error(*reason);
    const squeal::Disc damped = squeal::with_radiation(stage.disc, results.radiation);
    results.feedback = {speed, brake_at(stage.disc, setting.squeal, speed),
                        brake_at(damped, setting.squeal, speed)};
  });
  return results;
}

/// With the higher harmonics of the same motion found as a periodic one, whose fundamental differs
/// from that of a transient by what the transient has not settled yet.
Vibration with_harmonics(Vibration v, const squeal::Disc& disc,
                         const squeal::SquealOptions& options)
{
  const auto cycle = squeal::limit_cycle_direct(squeal::FlexibleDisc(disc, options), v.speed);
  Eigen::MatrixXcd all = squeal::cycle_harmonics(disc, options, cycle);
  all.col(0) = v.harmonics.col(0);
  v.harmonics = std::move(all);
  return v;
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
  const squeal::FlexibleDisc flexible(disc, setting.squeal);
  if (!(squeal::least_stable_eigenvalue(flexible.state_matrix(speed)).real() > 0.0))
    return loudness;
  const auto cycle = squeal::limit_cycle_direct(flexible, speed);
  const Vibration vibration{.speed = speed,
                            .omega = 2.0 * std::numbers::pi * cycle.frequency_Hz,
                            .modes = modes_of(disc),
                            .harmonics = squeal::cycle_harmonics(disc, setting.squeal, cycle)};
  const auto sounding = tones(stage.source(), vibration, setting.sound.harmonics);
  loudness.frequency_Hz = cycle.frequency_Hz;
  loudness.pad_velocity = cycle.pad_velocity;
  for (const Tone& tone : sounding) loudness.power += near_power(tone);
  for (const Heard& heard : listen(sounding, setting.sound.microphones))
    loudness.rms_dB.push_back(heard.rms_dB);
  return loudness;
}

/// Levels at the speeds of the scene, without and with the damping by sound.
void add_loudness(SoundResults& results, const Setting& setting, const Stage& stage,
                  const StudyListener& listener)
{
  const double n = 2.0 * double(setting.sound.speeds.size());
  const squeal::Disc damped = squeal::with_radiation(stage.disc, results.radiation);
  const bool comparable = !hindrance(stage.disc, results.radiation);
  double done = 0.0;
  for (const double speed : setting.sound.speeds) {
    for (const bool with : {false, true}) {
      listener.progress("levels over the speed", done++ / n);
      if (with && !comparable) continue;  // a note says why
      attempt(results.notes, fmt::format("the levels at {:.6g} rad/s", speed), [&] {
        results.loudness.push_back(loudness_at(setting, stage, with ? damped : stage.disc, speed));
        results.loudness.back().damped = with;
      });
    }
  }
}

/// The listener with functions that do nothing where it has none.
StudyListener complete(StudyListener listener)
{
  if (!listener.progress) listener.progress = [](const std::string&, double) {};
  if (!listener.found) listener.found = [](const SoundResults&) {};
  return listener;
}

/// The harmonics that sound; those above the first are left out, with a note, where the motion is
/// not found once more as a periodic one.
Vibration sounding(Vibration vibration, const Setting& setting, const squeal::Disc& disc,
                   std::vector<std::string>& notes)
{
  if (setting.sound.harmonics == 1) return vibration;
  Vibration all = vibration;
  attempt(notes, "the tones above the first",
          [&] { all = with_harmonics(std::move(vibration), disc, setting.squeal); });
  return all;
}

}  // namespace

SoundResults radiation_study(const Setting& setting, double speed, const StudyListener& listener)
{
  return with_radiation_of(setting, make_stage(setting.body, setting.squeal, setting.sound), speed,
                           complete(listener));
}

SoundResults sound_study(const Setting& setting, const squeal::SquealResults& squeal_results,
                         const StudyListener& listener)
{
  const StudyListener told = complete(listener);
  const Stage stage = make_stage(setting.body, setting.squeal, setting.sound);
  Vibration vibration = chosen_vibration(squeal_results, setting.sound.cycle, stage.disc);
  check_microphones(stage.body.outline, setting.sound.microphones);
  const int n_harmonics = setting.sound.harmonics;
  std::vector<std::string> notes;
  if (!setting.damped) vibration = sounding(std::move(vibration), setting, stage.disc, notes);
  check_air(stage.source(), vibration, n_harmonics);
  SoundResults results = with_radiation_of(setting, stage, vibration.speed, told);
  results.notes.insert(results.notes.end(), notes.begin(), notes.end());
  if (setting.damped) {
    const squeal::Disc damped = squeal::with_radiation(stage.disc, results.radiation);
    vibration = sounding(std::move(vibration), setting, damped, results.notes);
  }
  told.progress("sound", 0.0);
  results.vibration = vibration;
  results.tones = tones(stage.source(), vibration, n_harmonics);
  for (const Tone& tone : results.tones)
    results.accuracy.push_back(accuracy(stage.source(), vibration, tone));
  results.heard = listen(results.tones, setting.sound.microphones);
  results.directivity = directivity(results.tones);
  if (!setting.sound.speeds.empty()) told.found(results);
  add_loudness(results, setting, stage, told);
  return results;
}

double speed_of(const squeal::SquealOptions& options)
{
  if (options.study.transient) return options.study.transient->speed;
  if (options.study.limit_cycle_direct) return options.study.limit_cycle_direct->speed;
  return options.study.speeds.to;
}

Onset onset_of(const squeal::SquealResults& results, CycleChoice choice)
{
  Onset onset;
  if (!results.transient || !results.limit_cycle || choice == CycleChoice::direct) return onset;
  if (!(results.limit_cycle->pad_velocity > 0.0)) return onset;
  onset.t = results.transient->envelope.t;
  for (const double v : results.transient->envelope.pad_velocity)
    onset.amplitude.push_back(v / results.limit_cycle->pad_velocity);
  return onset;
}

}  // namespace chladni::sound
