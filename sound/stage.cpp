#include "sound/stage.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "squeal/brake/mode_parts.hpp"
#include "squeal/cycle/limit_cycle.hpp"

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

}  // namespace

std::vector<int> modes_of(const squeal::Disc& disc)
{
  std::vector<int> modes;
  for (const int number : disc.mode_numbers) modes.push_back(number - 1);
  return modes;
}

Stage make_stage(const mbs_export::ModalBody& body, const squeal::SquealOptions& squeal,
                 const SoundOptions& sound)
{
  squeal::Disc disc = squeal::make_disc(body, squeal::ring_choice(squeal), squeal.modes);
  squeal::refuse_aliases(disc, body);
  ThickBody thick = thick_body(sound.lines, sound.hub, sound.holes);
  SurfaceMotion motion(body, thick, modes_of(disc), harmonics_of(disc));
  return {std::move(disc), std::move(thick), std::move(motion), sound.air};
}

Vibration chosen_vibration(const squeal::SquealResults& results, CycleChoice choice,
                           const squeal::Disc& disc)
{
  Vibration vibration = vibration_in(results, choice);
  check_modes(vibration, disc);
  return vibration;
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

}  // namespace chladni::sound
