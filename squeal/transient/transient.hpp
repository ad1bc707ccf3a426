#pragma once

#include <functional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/checkpoint.hpp"
#include "squeal/transient/wav_spool.hpp"

namespace chladni::squeal {

/// Called now and then with the fraction done, 0 to 1.
using Progress = std::function<void(double)>;

/// What goes along with a long transient.
struct Keeping {
  Progress progress = {};
  Checkpoint* checkpoint =
      nullptr;                ///< its state goes there, and the run begins with what is there
  WavSpool* sound = nullptr;  ///< takes the pad velocity as sound
};

/// The motion after a small displacement of the first pads, at rest in the inertial frame, by the
/// integrator of the scene or the one that integrator_choice.hpp chooses. An axisymmetric disc
/// starts in its first pair of modes with a_cos = a_sin, the crest of the cosine mode under the
/// first pad; any other disc starts with the smallest modal displacement that moves the first pad
/// so far, at rest in the disc. A brake without a body takes steps of order 8. A motion that
/// diverges ends early, with what was recorded so far. The memory that it takes does not grow with
/// its duration.
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, too few steps for the highest mode, and from `choose_integrator`.
Transient transient(const Brake& brake, const TransientCase& run, const Keeping& keeping = {});

/// "the motion diverged after 0.3 s; ...", of a run that did not finish.
std::string divergence_of(const Transient& run);

/// Growth of a small disturbance at `speed` (rad/s) over `duration` (s), far below contact loss.
/// @throws chladni::Error when it is too short for a rate.
Growth growth(const Brake& brake, double speed, double duration);

}  // namespace chladni::squeal
