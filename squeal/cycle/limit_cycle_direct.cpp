#include "squeal/cycle/limit_cycle_direct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/continuation.hpp"
#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

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
std::optional<DirectLimitCycle> measured_direct_cycle(const Brake& brake, AutonomousMotion& motion,
                                                      const std::optional<PeriodicOrbit>& orbit,
                                                      double speed)
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
    if (auto cycle =
            measured_direct_cycle(brake, *motion, orbit_from(*motion, start.cycle), speed)) {
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
  return measured_direct_cycle(brake, *motion, periodic_orbit(*motion, start), speed);
}

namespace {

/// Where the search for the Hopf point begins, relative to the speed.
constexpr double lowest_speed = 0.01;
/// Steps along the branch, as branch_follower.cpp takes them.
constexpr double arc_first = 0.05, arc_max = 0.3, arc_min = 1e-3;
constexpr int steps_of_search_max = 60;
/// Where the branch is left, relative to the speed, and to the small cycle with which it begins.
constexpr double highest_speed = 2.0, at_rest = 0.05;

constexpr int n_chunks = 30;
constexpr double periods_per_chunk = 100.0;
/// Of the integration of a transient that only leads to a start.
constexpr double rough_tolerance = 1e-7;
/// Samples of three periods among which the return of a state is looked for.
constexpr int n_rough_samples = 600;
constexpr double periods_looked_at = 3.0;
/// A return this much farther off than the nearest one counts too: the first of them is one period.
constexpr double as_near = 2.0;
/// Distance after one period, relative, from which Newton's method has a chance.
constexpr double comes_back = 0.1;

/// The limit at which stability is lost, the nearest below the speed.
std::optional<StabilityPoint> limit_below(const Brake& brake, double speed)
{
  const StabilityProfile profile = stability_over_speed(
      state_matrix_at(brake), {.from = lowest_speed * speed, .to = speed, .count = 2});
  if (profile.unstable.empty() || profile.unstable.back().from.value == profile.from.value)
    return std::nullopt;
  return profile.unstable.back().from;
}

/// A state of a motion and when it comes near to itself again.
struct Return {
  CycleStart start;
  double distance;  ///< relative
};

/// The first of the minima that are about as deep as the deepest, but for what samples resolve;
/// after the state has gone away.
Eigen::Index first_return(const Eigen::VectorXd& distance)
{
  const Eigen::Index n = distance.size();
  Eigen::Index away = 1;
  while (away + 1 < n && distance[away + 1] >= distance[away]) ++away;
  const double resolved = (distance.tail(n - 1) - distance.head(n - 1)).cwiseAbs().maxCoeff();
  const double near = as_near * distance.tail(n - away).minCoeff() + resolved;
  Eigen::Index i = away;
  while (i + 1 < n && !(distance[i] <= near && distance[i + 1] >= distance[i])) ++i;
  return i;
}

/// @param period  of the eigenvector: that of the motion is between a third and three times it
Return return_of(AutonomousMotion& motion, const Eigen::VectorXd& x, double period)
{
  const double span = periods_looked_at * period;
  const Eigen::MatrixXd states =
      states_over_period(motion, {x, span}, n_rough_samples, rough_tolerance);
  const Eigen::VectorXd distance = (states.colwise() - x).colwise().norm() / x.norm();
  const Eigen::Index i = first_return(distance);
  return {{x, span * double(i) / n_rough_samples}, distance[i]};
}

}  // namespace

Detour cycle_by_continuation(const Brake& brake, double speed)
{
  const auto limit = limit_below(brake, speed);
  if (!limit) return {{}, "there is no Hopf point at lower speeds to continue from"};
  const AutonomousMotionAt motion = [&brake](double at) { return brake.motion(at); };
  const std::string from = fmt::format("the Hopf point at {:.6g} rad/s", limit->value);
  auto point = cycle_at_hopf(brake, motion, *limit);
  if (!point) return {{}, "no small cycle was found at " + from};
  const double smallest = at_rest * point->at.x.norm();
  double length = arc_first;
  for (int i = 0; i < steps_of_search_max && length > arc_min; ++i) {
    const auto next = next_on_arc(motion, *point, length);
    if (!next) {
      length *= 0.5;
      continue;
    }
    if (point->speed < speed && next->speed >= speed) {
      const double s = (speed - point->speed) / (next->speed - point->speed);
      const CycleStart near{point->at.x + s * (next->at.x - point->at.x),
                            point->at.period + s * (next->at.period - point->at.period)};
      auto cycle = limit_cycle_near(brake, speed, near);
      if (cycle) return {std::move(cycle), "by continuation from " + from};
    }
    point = next;
    length = std::min(1.5 * length, arc_max);
    if (point->at.x.norm() < smallest) {
      return {{},
              fmt::format("the branch from {} ends at rest at {:.6g} rad/s", from, point->speed)};
    }
    if (point->speed < lowest_speed * speed || point->speed > highest_speed * speed)
      return {{}, fmt::format("the branch from {} leads to {:.6g} rad/s", from, point->speed)};
  }
  return {{},
          fmt::format("the branch from {} was followed to {:.6g} rad/s only", from, point->speed)};
}

Detour cycle_by_transient(const Brake& brake, double speed)
{
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(speed);
  const EigenPair pair = least_stable_pair(brake.state_matrix(speed));
  Eigen::VectorXd x = moving_the_pad(*motion, pair.u, brake.rest_compression()).real();
  const double period = 2.0 * pi / pair.lambda.imag();
  Return last{{x, period}, 1.0};
  for (int i = 1; i <= n_chunks; ++i) {
    x = end_of(*motion, {x, periods_per_chunk * period}, rough_tolerance);
    if (!x.allFinite()) return {{}, "a transient diverged or a contact switched endlessly"};
    last = return_of(*motion, x, period);
    if (!(last.distance <= comes_back)) continue;
    auto cycle = limit_cycle_near(brake, speed, last.start);
    if (cycle) {
      return {std::move(cycle),
              fmt::format("after a transient of {:.0f} periods", i * periods_per_chunk)};
    }
  }
  return {
      {},
      fmt::format("after {:.0f} periods a transient still changed by {:.2g} % from one period to "
                  "the next",
                  n_chunks * periods_per_chunk, 100.0 * last.distance)};
}

namespace {

/// Points of the cycle from which peaks, amplitudes and energies are taken: a parabola through
/// three of them misses the peak of a sine by 1e-8.
constexpr int samples_of_period = 256;
/// Of two of these parts, for the lowest speed of sliding.
constexpr int n_finer = 40;

/// What the first pad pair does during one period.
struct PadSamples {
  Eigen::VectorXd z{samples_of_period}, z_dot{samples_of_period}, N{samples_of_period},
      slip_speed{samples_of_period};

  void set(int i, const ContactResult<double>& pads)
  {
    z[i] = pads.upper.z;
    z_dot[i] = pads.upper.z_dot;
    N[i] = pads.upper.N;
    slip_speed[i] = std::min(pads.upper.slip_speed, pads.lower.slip_speed);
  }
};

/// The lowest speed of sliding of the first pads, by finer samples about that of the given ones:
/// where it nearly stops, sliding turns within microseconds.
double lowest_slip(AutonomousMotion& motion, const PadSamples& pad, const Eigen::MatrixXd& states,
                   const PeriodicOrbit& orbit)
{
  Eigen::Index i = 0;
  double lowest = pad.slip_speed.minCoeff(&i);
  const CycleStart about{states.col((i + samples_of_period - 1) % samples_of_period),
                         2.0 * orbit.at.period / samples_of_period};
  const Eigen::MatrixXd finer = states_over_period(motion, about, n_finer, orbit.tolerance);
  for (int k = 0; k < n_finer; ++k) {
    const ContactResult<double> at = motion.first_contact(finer.col(k));
    lowest = std::min({lowest, at.upper.slip_speed, at.lower.slip_speed});
  }
  return lowest;
}

/// All but modes and energies.
DirectLimitCycle seen_at_pad(const PadSamples& pad, const PeriodicOrbit& orbit, double speed)
{
  const PadAmplitudes amplitudes = pad_amplitudes(pad.z, pad.z_dot);
  return {.speed = speed,
          .frequency_Hz = 1.0 / orbit.at.period,
          .pad_velocity = amplitudes.velocity,
          .pad_displacement = amplitudes.displacement,
          .N_min = -peak(-pad.N),
          .N_max = peak(pad.N),
          .slip_speed_min = pad.slip_speed.minCoeff(),
          .multipliers = orbit.multipliers.values,
          .multiplier_error = orbit.multipliers.error,
          .n_newton_steps = orbit.n_newton_steps,
          .n_contact_evaluations = 0,
          .x = orbit.at.x,
          .mode_numbers = {},
          .amplitude = {},
          .energy = {}};
}

/// The amplitudes along the modes of the body, turned in time so that the largest is real.
Eigen::VectorXcd body_amplitude(const InertialDisc& disc, const Eigen::VectorXcd& fundamental)
{
  const Eigen::VectorXcd amplitude = disc.R * fundamental;
  Eigen::Index largest = 0;
  const double modulus = amplitude.cwiseAbs().maxCoeff(&largest);
  return amplitude * (std::conj(amplitude[largest]) / modulus);
}

CycleEnergy no_energy(std::size_t n_pads)
{
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n_pads));
  return {zero, zero, 0.0, zero, 0.0};
}

DirectLimitCycle measured_with_body(const FlexibleDisc& brake, SlidingDisc& motion,
                                    const PeriodicOrbit& orbit)
{
  const InertialDisc& disc = brake.inertial();
  const Eigen::MatrixXd states =
      states_over_period(motion, orbit.at, samples_of_period, orbit.tolerance);
  const Eigen::Index n = disc.n_modes();
  PadSamples pad;
  CycleEnergy energy = no_energy(motion.n_pads());
  Eigen::VectorXcd fundamental = Eigen::VectorXcd::Zero(n);
  const double step = orbit.at.period / samples_of_period;
  for (int i = 0; i < samples_of_period; ++i) {
    const auto x = states.col(i);
    const SlidingDisc::Sample now = motion.sample(x);
    pad.set(i, now.first);
    energy.friction += step * now.power.friction;
    energy.normal += step * now.power.normal;
    energy.damping += step * now.power.damping;
    energy.heat += step * now.power.heat;
    energy.stored += 0.5 * x.squaredNorm() / samples_of_period;
    fundamental += std::polar(2.0 / samples_of_period, -2.0 * pi * i / samples_of_period) *
                   x.head(n).cwiseQuotient(disc.omega);
  }
  DirectLimitCycle cycle = seen_at_pad(pad, orbit, motion.speed());
  cycle.slip_speed_min = lowest_slip(motion, pad, states, orbit);
  cycle.mode_numbers = brake.disc().mode_numbers;
  cycle.amplitude = body_amplitude(disc, fundamental);
  cycle.energy = energy;
  cycle.n_contact_evaluations = motion.n_evaluations();
  return cycle;
}

}  // namespace

DirectLimitCycle measured_cycle(const Brake& brake, AutonomousMotion& motion,
                                const PeriodicOrbit& orbit, double speed)
{
  if (const FlexibleDisc* body = brake.body())
    return measured_with_body(*body, dynamic_cast<SlidingDisc&>(motion), orbit);
  const Eigen::MatrixXd states =
      states_over_period(motion, orbit.at, samples_of_period, orbit.tolerance);
  PadSamples pad;
  for (int i = 0; i < samples_of_period; ++i) pad.set(i, motion.first_contact(states.col(i)));
  DirectLimitCycle cycle = seen_at_pad(pad, orbit, speed);
  cycle.slip_speed_min = lowest_slip(motion, pad, states, orbit);
  cycle.n_contact_evaluations = motion.n_evaluations();
  return cycle;
}

namespace {

/// The largest sample and what lies beside it.
struct Summit {
  Eigen::Index left, top, right;

  explicit Summit(const Eigen::VectorXd& x)
  {
    x.maxCoeff(&top);
    left = (top + x.size() - 1) % x.size();
    right = (top + 1) % x.size();
  }
  bool is_round(const Eigen::VectorXd& x) const { return x[left] < x[top] && x[right] < x[top]; }
  double slope(const Eigen::VectorXd& x) const { return x[right] - x[left]; }
  double bend(const Eigen::VectorXd& x) const { return x[left] - 2.0 * x[top] + x[right]; }
};

}  // namespace

double peak(const Eigen::VectorXd& x)
{
  const Summit at(x);
  if (!at.is_round(x)) return x[at.top];
  return x[at.top] - at.slope(x) * at.slope(x) / (8.0 * at.bend(x));
}

double peak_change(const Eigen::VectorXd& x, const Eigen::VectorXd& dx)
{
  const Summit at(x);
  if (!at.is_round(x)) return dx[at.top];
  const double ratio = at.slope(x) / at.bend(x);
  return dx[at.top] - ratio * at.slope(dx) / 4.0 + ratio * ratio * at.bend(dx) / 8.0;
}

PadAmplitudes pad_amplitudes(const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot)
{
  return {std::max(peak(z_dot), peak(-z_dot)), 0.5 * (peak(z) + peak(-z))};
}

}  // namespace chladni::squeal
