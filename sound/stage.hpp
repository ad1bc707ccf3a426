#pragma once

#include <vector>

#include "sound/sound_options.hpp"
#include "sound/surface_motion.hpp"
#include "sound/tone.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::sound {

/// What all steps of a study need.
struct Stage {
  squeal::Disc disc;
  ThickBody body;
  SurfaceMotion motion;
  AirOptions air;

  Source source() const { return {body, motion, air}; }
};

/// @throws chladni::Error from make_disc, thick_body and SurfaceMotion.
Stage make_stage(const mbs_export::ModalBody& body, const squeal::SquealOptions& squeal,
                 const SoundOptions& sound);

/// The modes of the disc, 0-based in the body.
std::vector<int> modes_of(const squeal::Disc& disc);

/// The periodic motion of a squeal study that sounds: its fundamental.
/// @throws chladni::Error when there is none, when it has no amplitudes in the standing frame, and
///         when it is of other modes than those of the disc.
Vibration chosen_vibration(const squeal::SquealResults& results, CycleChoice choice,
                           const squeal::Disc& disc);

/// @throws chladni::Error naming a microphone inside the body.
void check_microphones(const Outline& outline, const std::vector<Microphone>& microphones);

}  // namespace chladni::sound
