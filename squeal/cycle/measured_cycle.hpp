#pragma once

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/motion/autonomous_motion.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// What is reported of an orbit of the brake at a speed (rad/s): what its first pads do and, of one
/// with a body, the amplitudes of its modes and the work in a period.
/// @param motion  of the brake at this speed, with the evaluations that led to the orbit
DirectLimitCycle measured_cycle(const Brake& brake, AutonomousMotion& motion,
                                const PeriodicOrbit& orbit, double speed);

}  // namespace chladni::squeal
