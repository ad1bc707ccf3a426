#pragma once

#include <vector>

#include "sound/sound_options.hpp"
#include "sound/surface_motion.hpp"
#include "sound/tone.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::sound {

/// Disc, body, surface motion and air: what all steps of a sound study use.
struct Stage {
  squeal::Disc disc;
  ThickBody body;
  SurfaceMotion motion;
  AirOptions air;

  Source source() const { return {body, motion, air}; }
};

/// Prepares a sound study.
/// @throws chladni::Error from make_disc, thick_body and SurfaceMotion.
Stage make_stage(const mbs_export::ModalBody& body, const squeal::SquealOptions& squeal,
                 const SoundOptions& sound);

/// The disc's modes as 0-based numbers of the body's modes.
std::vector<int> modes_of(const squeal::Disc& disc);

/// The periodic motion, with its fundamental harmonic only, whose sound is computed.
/// @throws chladni::Error when there is none, when it has no amplitudes in the fixed frame, when it
///         consists of other modes than those of the disc, and when its frequency is far above
///         them.
Vibration chosen_vibration(const squeal::SquealResults& results, CycleChoice choice,
                           const squeal::Disc& disc);

/// Checks the positions of the microphones.
/// @throws chladni::Error naming a microphone inside the body.
void check_microphones(const Outline& outline, const std::vector<Microphone>& microphones);

}  // namespace chladni::sound
