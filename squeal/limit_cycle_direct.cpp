#include "squeal/limit_cycle_direct.hpp"

#include <fmt/format.h>

#include <complex>
#include <memory>
#include <numbers>

#include "common/error.hpp"
#include "squeal/harmonic_balance.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// Amplitudes to begin with, relative to the displacement at which a pad loses its force.
constexpr double start_amplitudes[] = {2.0, 4.0, 1.0, 8.0, 16.0, 0.5, 0.25, 0.1};
/// Of an eigenvector, in the same measure: it moves the pad in proportion to itself.
constexpr double small = 1e-5;
/// Harmonics of the start of the shooting: one to come near, three for three to four digits.
constexpr HarmonicResolution coarse{.n_harmonics = 1, .n_samples = 16, .tolerance = 5e-2};
constexpr HarmonicResolution fine{.n_harmonics = 3, .n_samples = 32, .tolerance = 1e-2};

/// Displacement of the first upper pad for each unit of v, m.
Complex pad_displacement(AutonomousMotion& motion, const Eigen::VectorXcd& v, double compression)
{
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(v.size());
  const double z_0 = motion.first_contact(rest).upper.z;
  const auto moved = [&](const Eigen::VectorXd& x, double scale) {
    return (motion.first_contact(scale * x).upper.z - z_0) / scale;
  };
  const double first = std::abs(moved(v.real(), 1e-6)) + std::abs(moved(v.imag(), 1e-6));
  const double scale = small * compression / first;
  return {moved(v.real(), scale), moved(v.imag(), scale)};
}

/// Re(v exp(i omega t)) of the least stable eigenvector, which displaces the first pad by its
/// compression.
HarmonicCycle start_from_eigenvector(AutonomousMotion& motion, const Eigen::MatrixXd& A,
                                     double compression)
{
  const EigenPair unstable = least_stable_pair(A);
  Eigen::VectorXcd v = Eigen::VectorXcd::Zero(motion.size());
  v.head(A.rows()) = unstable.u;
  v *= compression / pad_displacement(motion, v, compression);
  HarmonicCycle start{Eigen::MatrixXd::Zero(v.size(), 3), unstable.lambda.imag()};
  start.X.col(1) = v.real();
  start.X.col(2) = -v.imag();
  return start;
}

/// By harmonic balance, then by shooting; by shooting alone where the balance fails.
std::optional<PeriodicOrbit> orbit_from(AutonomousMotion& motion, const HarmonicCycle& start)
{
  const auto shot_from = [&](const HarmonicCycle& cycle) {
    return periodic_orbit(motion, {start_of(cycle), 2.0 * pi / cycle.omega});
  };
  if (const auto near = harmonic_balance(motion, start, coarse))
    if (const auto nearer = harmonic_balance(motion, *near, fine))
      if (auto orbit = shot_from(*nearer)) return orbit;
  return shot_from(start);
}

/// The cycle of an orbit, unless that is rest.
std::optional<DirectLimitCycle> cycle_of(const CycleProblem& problem, AutonomousMotion& motion,
                                         const std::optional<PeriodicOrbit>& orbit, double speed)
{
  if (!orbit) return std::nullopt;
  DirectLimitCycle cycle = problem.measured(motion, *orbit, speed);
  if (cycle.pad_displacement < cycle_at_rest * problem.compression) return std::nullopt;
  return cycle;
}

}  // namespace

DirectLimitCycle limit_cycle_direct(const CycleProblem& problem, double speed)
{
  const Eigen::MatrixXd A = problem.state_matrix(speed);
  const double growth = least_stable_eigenvalue(A).real();
  if (!(growth > 0.0))
    throw Error(
        fmt::format("limit cycle: the sliding disc is stable at {:.6g} rad/s (largest growth rate "
                    "{:.3g} 1/s); a limit cycle grows from an unstable one",
                    speed, growth));
  const std::unique_ptr<AutonomousMotion> motion = problem.motion(speed);
  const HarmonicCycle unit = start_from_eigenvector(*motion, A, problem.compression);
  for (const double amplitude : start_amplitudes) {
    const HarmonicCycle start{amplitude * unit.X, unit.omega};
    if (auto cycle = cycle_of(problem, *motion, orbit_from(*motion, start), speed)) return *cycle;
  }
  throw Error(
      fmt::format("limit cycle: Newton's method finds no periodic motion at {:.6g} rad/s; simulate "
                  "a transient instead",
                  speed));
}

std::optional<DirectLimitCycle> limit_cycle_near(const CycleProblem& problem, double speed,
                                                 const CycleStart& start)
{
  const std::unique_ptr<AutonomousMotion> motion = problem.motion(speed);
  return cycle_of(problem, *motion, periodic_orbit(*motion, start), speed);
}

DirectLimitCycle limit_cycle_direct(const Disc& disc, const SquealOptions& options, double speed)
{
  return limit_cycle_direct(cycle_problem(disc, options), speed);
}

std::optional<DirectLimitCycle> limit_cycle_near(const Disc& disc, const SquealOptions& options,
                                                 double speed, const CycleStart& start)
{
  return limit_cycle_near(cycle_problem(disc, options), speed, start);
}

}  // namespace chladni::squeal
