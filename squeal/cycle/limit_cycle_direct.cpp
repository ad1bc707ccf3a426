#include "squeal/cycle/limit_cycle_direct.hpp"

#include <fmt/format.h>

#include <memory>
#include <numbers>
#include <string>

#include "common/error.hpp"
#include "squeal/cycle/cycle_detours.hpp"
#include "squeal/cycle/cycle_guess.hpp"
#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/cycle/measured_cycle.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Before the shooting: three harmonics, for three to four digits.
constexpr HarmonicResolution balanced{.n_harmonics = 3, .n_samples = 64, .tolerance = 1e-2};

/// By harmonic balance, then by shooting; by shooting alone where the balance fails.
std::optional<PeriodicOrbit> orbit_from(AutonomousMotion& motion, const HarmonicCycle& start)
{
  const auto shot_from = [&](const HarmonicCycle& cycle) {
    return periodic_orbit(motion, {start_of(cycle), 2.0 * pi / cycle.omega});
  };
  if (const auto near = harmonic_balance(motion, start, balanced))
    if (auto orbit = shot_from(*near)) return orbit;
  return shot_from(start);
}

/// The cycle of an orbit, unless that is rest.
std::optional<DirectLimitCycle> cycle_of(const Brake& brake, AutonomousMotion& motion,
                                         const std::optional<PeriodicOrbit>& orbit, double speed)
{
  if (!orbit) return std::nullopt;
  DirectLimitCycle cycle = measured_cycle(brake, motion, *orbit, speed);
  if (cycle.pad_displacement < cycle_at_rest * brake.rest_compression()) return std::nullopt;
  return cycle;
}

}  // namespace

DirectLimitCycle limit_cycle_direct(const Brake& brake, double speed)
{
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(speed);
  const Eigen::MatrixXd A = brake.state_matrix(speed);
  const double growth = least_stable_eigenvalue(A).real();
  if (!(growth > 0.0)) {
    throw Error(
        fmt::format("limit cycle: the sliding disc is stable at {:.6g} rad/s (largest growth rate "
                    "{:.3g} 1/s); a limit cycle grows from an unstable one",
                    speed, growth));
  }
  for (const CycleGuess& start : cycle_guesses(*motion, A, brake.rest_compression())) {
    if (auto cycle = cycle_of(brake, *motion, orbit_from(*motion, start.cycle), speed)) {
      cycle->way = "from the eigenvector";
      return *cycle;
    }
  }
  std::string tried;
  for (const auto& detour : {cycle_by_continuation, cycle_by_transient}) {
    Detour end = detour(brake, speed);
    if (end.cycle) {
      end.cycle->way = end.said;
      return *end.cycle;
    }
    tried += ", " + end.said;
  }
  throw Error(fmt::format(
      "limit cycle: Newton's method finds no periodic motion at {:.6g} rad/s: it does not "
      "converge from the unstable eigenvector at any amplitude{}; simulate a transient to "
      "see what the brake does",
      speed, tried));
}

std::optional<DirectLimitCycle> limit_cycle_near(const Brake& brake, double speed,
                                                 const CycleStart& start)
{
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(speed);
  return cycle_of(brake, *motion, periodic_orbit(*motion, start), speed);
}

}  // namespace chladni::squeal
