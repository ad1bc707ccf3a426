#pragma once

#include <functional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/checkpoint.hpp"
#include "squeal/transient/wav_spool.hpp"

namespace chladni::squeal {

/// Callback with the fraction done, 0 to 1.
using Progress = std::function<void(double)>;

/// Callbacks and storage for a long transient.
struct Keeping {
  Progress progress = {};
  Checkpoint* checkpoint = nullptr;  ///< stores the state, and provides the state to start with
  WavSpool* sound = nullptr;         ///< receives the pad velocity as sound
};

/// The motion after a small displacement of the first pads, at rest in the inertial frame, by the
/// integrator of the scene or the one of integrator_choice.hpp. An axisymmetric disc starts in its
/// first pair of modes with a_cos = a_sin and the crest of the cosine mode under the first pad.
/// Other discs start with the smallest modal displacement that moves the first pad by this amount,
/// at rest in the disc. A brake without a body uses fixed steps of order 8. A diverging motion ends
/// early with the data recorded so far. The memory does not grow with the duration.
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, too few steps for the highest mode, and from `choose_integrator`.
Transient transient(const Brake& brake, const TransientCase& run, const Keeping& keeping = {});

/// A message on a run that did not finish: "the motion diverged after 0.3 s; ...".
std::string divergence_of(const Transient& run);

/// Growth of a small disturbance at `speed` (rad/s) over `duration` (s), far below loss of contact.
/// @throws chladni::Error when the duration is too short for a rate.
Growth growth(const Brake& brake, double speed, double duration);

}  // namespace chladni::squeal
