#pragma once

#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

/// Largest relative change of the effective pad velocity, from the first to the second half of the
/// rotations, that counts as settled.
inline constexpr double settled_rms_drift = 1e-2;

/// Statistics over the last eight rotations of a transient, or over the last six or four if eight
/// take more than the second half of the run. They assume no period and so apply to motions with
/// several frequencies; check `settled` before use.
/// @throws chladni::Error when the transient diverged, when four rotations take more than half of
///         it, when its speed changes within them, and when its history is too coarse for the
///         motion.
MotionStatistics motion_statistics(const Transient& transient);

}  // namespace chladni::squeal
