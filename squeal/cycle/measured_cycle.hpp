#pragma once

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/motion/autonomous_motion.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The reported quantities of an orbit of the brake at a speed (rad/s): the motion of its first
/// pads and, with a modal body, the modal amplitudes and the work per period.
/// @param motion  motion of the brake at this speed, which counts the evaluations of the search
DirectLimitCycle measured_cycle(const Brake& brake, AutonomousMotion& motion,
                                const PeriodicOrbit& orbit, double speed);

}  // namespace chladni::squeal
