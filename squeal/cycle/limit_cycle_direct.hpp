#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/motion/motion.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// The limit cycle at `speed` (rad/s) without a transient. The search starts with the unstable
/// eigenvector of the sliding brake at the amplitude where its averaged growth vanishes
/// (cycle_guess.hpp), refines it by harmonic balance and then by shooting. If that fails, it tries
/// other amplitudes, then the branch from the Hopf point and a short transient (cycle_detours.hpp);
/// `way` names the successful start.
/// @throws chladni::Error when the brake has no autonomous motion, when it is stable at this speed,
///         and, with a list of the attempts, when none leads to a periodic motion.
DirectLimitCycle limit_cycle_direct(const Brake& brake, double speed);

/// The limit cycle at `speed` (rad/s) from a given start, such as the cycle at a nearby speed;
/// absent when Newton's method does not converge or ends at rest.
std::optional<DirectLimitCycle> limit_cycle_near(const Brake& brake, double speed,
                                                 const CycleStart& start);

/// Amplitude relative to the compression of the first pad below which a cycle counts as rest.
inline constexpr double cycle_at_rest = 1e-4;

/// Result of an indirect search for a limit cycle.
struct Detour {
  std::optional<DirectLimitCycle> cycle;
  std::string said;  ///< outcome in words, to follow a comma
};

/// Searches the limit cycle at `speed` (rad/s) by continuation of the branch from the nearest Hopf
/// point below, at which sliding loses its stability, down to a hundredth of the speed.
Detour cycle_by_continuation(const Brake& brake, double speed);

/// Searches the limit cycle at `speed` (rad/s) by a short transient. It starts with the unstable
/// eigenvector at an amplitude that moves the first pad by its compression at rest. Every hundred
/// periods its state and the time after which the state nearly recurs start Newton's method; it
/// ends after three thousand periods.
Detour cycle_by_transient(const Brake& brake, double speed);

/// The reported quantities of an orbit of the brake at a speed (rad/s): the motion of its first
/// pads and, with a modal body, the modal amplitudes and the work per period.
/// @param motion  motion of the brake at this speed, which counts the evaluations of the search
DirectLimitCycle measured_cycle(const Brake& brake, AutonomousMotion& motion,
                                const PeriodicOrbit& orbit, double speed);

/// The largest of equally spaced samples of one period, refined by a parabola unless it is a
/// plateau.
double peak(const Eigen::VectorXd& x);

/// Derivative of the peak of x + s dx by s.
double peak_change(const Eigen::VectorXd& x, const Eigen::VectorXd& dx);

/// Amplitudes of a pad over a period.
struct PadAmplitudes {
  double velocity;      ///< largest, m/s
  double displacement;  ///< half the stroke, m
};

/// The amplitudes of samples of a displacement (m) and its velocity (m/s) over a period.
PadAmplitudes pad_amplitudes(const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot);

}  // namespace chladni::squeal
