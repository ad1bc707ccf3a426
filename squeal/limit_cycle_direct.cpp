#include "squeal/limit_cycle_direct.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "common/error.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/sliding_disc.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// Steps for one period of the fastest mode at first: order 8 leaves about 1e-11 per period where
/// friction keeps its direction. They double as long as the multiplier along the cycle, which is 1,
/// is not.
constexpr int steps_per_period_min = 16;
constexpr int steps_per_period_max = 1024;
constexpr double multiplier_error = 1e-6;
/// Points of the cycle from which peaks and amplitudes are taken: a parabola through three of them
/// misses the peak of a sine by 1e-8.
constexpr int n_samples = 256;
constexpr int newton_steps_max = 25;
/// Change of x_0, relative, at which Newton's method has converged; the next step would be its
/// square.
constexpr double converged = 1e-8;
/// Largest change of x_0 in one step, relative.
constexpr double largest_change = 0.5;
/// A cycle below this fraction of the displacement at which a pad loses its force is taken for
/// rest.
constexpr double rest = 1e-4;
/// Amplitudes to begin with, in the same measure.
constexpr double start_amplitudes[] = {2.0, 4.0, 1.0, 8.0, 16.0, 0.5, 0.25, 0.1};

double compression(const SquealOptions& options)
{
  return options.pads.front().preload / options.pads.front().stiffness;
}

int steps_over(const InertialDisc& disc, double time, int steps_per_period)
{
  return static_cast<int>(std::ceil(steps_per_period * disc.omega.maxCoeff() * time / (2.0 * pi)));
}

/// Re(v) of the least stable eigenvector with the displacement `amplitude` (m) under the first pad.
CycleStart start_from_eigenvector(const InertialDisc& disc, const SquealOptions& options,
                                  double speed, double amplitude)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(state_matrix(disc, options, speed));
  const Complex expected = least_stable_eigenvalue(disc, options, speed);
  Eigen::Index i = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&i);
  const Eigen::VectorXcd v = solver.eigenvectors().col(i);
  const Eigen::Index n = disc.n_modes();
  const Eigen::VectorXd W_by_omega =
      shapes_at(disc, options.pads.front().angle).W.cwiseQuotient(disc.omega);
  const Complex at_pad = (W_by_omega.cast<Complex>().transpose() * v.head(n))[0];
  return {(v * (amplitude / at_pad)).real(), 2.0 * pi / expected.imag()};
}

/// A converged cycle with the derivative of the flow over its period.
struct Cycle {
  CycleStart at;
  Eigen::MatrixXd monodromy;
  int n_newton_steps;
  int steps_per_period;
};

/// [X - I, f(x_T); f(x_0)^T, 0] (dx, dT) = (x_0 - x_T, 0), with T scaled to the size of x.
std::optional<Cycle> find_cycle(SlidingDisc& motion, const InertialDisc& disc, CycleStart at,
                                int steps_per_period)
{
  const Eigen::Index n = motion.size();
  for (int i = 1; i <= newton_steps_max; ++i) {
    const SlidingDisc::Flow flow =
        motion.flow(at.x, at.period, steps_over(disc, at.period, steps_per_period));
    if (!flow.end.allFinite()) return std::nullopt;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n + 1, n + 1);
    J.topLeftCorner(n, n) = flow.derivative - Eigen::MatrixXd::Identity(n, n);
    J.col(n).head(n) = at.period * motion.rate(flow.end);
    J.row(n).head(n) = at.period * motion.rate(at.x).transpose();
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(n + 1);
    residual.head(n) = at.x - flow.end;
    const Eigen::VectorXd change = J.partialPivLu().solve(residual);
    const double size = change.head(n).norm() / at.x.norm() + std::abs(change[n]);
    if (!std::isfinite(size)) return std::nullopt;
    const double damping = std::min(1.0, largest_change / size);
    at.x += damping * change.head(n);
    at.period *= 1.0 + damping * change[n];
    if (size < converged) return Cycle{at, flow.derivative, i, steps_per_period};
  }
  return std::nullopt;
}

/// Eigenvalues of the monodromy matrix: the one nearest to 1 first, then by falling modulus.
Eigen::VectorXcd floquet_multipliers(const Eigen::MatrixXd& monodromy)
{
  Eigen::VectorXcd values = monodromy.eigenvalues();
  Eigen::Index along = 0;
  (values.array() - 1.0).abs().minCoeff(&along);
  std::swap(values[0], values[along]);
  std::sort(values.begin() + 1, values.end(), [](const Complex& a, const Complex& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return values;
}

double error_along(const Cycle& cycle)
{
  return std::abs(floquet_multipliers(cycle.monodromy)[0] - 1.0);
}

/// The largest of samples of one period, refined by a parabola unless it is a plateau.
double peak(const Eigen::VectorXd& x)
{
  Eigen::Index i = 0;
  const double top = x.maxCoeff(&i);
  const double left = x[(i + x.size() - 1) % x.size()], right = x[(i + 1) % x.size()];
  const double bend = left - 2.0 * top + right;
  return left < top && right < top ? top - (right - left) * (right - left) / (8.0 * bend) : top;
}

/// What the first pad pair and the modes do during one period.
struct Orbit {
  Eigen::VectorXd z, z_dot, N, slip_speed;  ///< [n_samples]
  Eigen::VectorXcd fundamental;             ///< [n_modes] of a
  CycleEnergy energy;
};

Orbit orbit(SlidingDisc& motion, const InertialDisc& disc, const Cycle& cycle)
{
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(motion.power(cycle.at.x).heat.size());
  Orbit samples{Eigen::VectorXd(n_samples),
                Eigen::VectorXd(n_samples),
                Eigen::VectorXd(n_samples),
                Eigen::VectorXd(n_samples),
                Eigen::VectorXcd::Zero(disc.n_modes()),
                {zero, zero, 0.0, zero, 0.0}};
  const double step = cycle.at.period / n_samples;
  const int n_steps = steps_over(disc, step, cycle.steps_per_period);
  Eigen::VectorXd x = cycle.at.x;
  for (int i = 0; i < n_samples; ++i) {
    const ContactResult<double> pads = motion.first_contact(x);
    samples.z[i] = pads.upper.z;
    samples.z_dot[i] = pads.upper.z_dot;
    samples.N[i] = pads.upper.N;
    samples.slip_speed[i] = std::min(pads.upper.slip_speed, pads.lower.slip_speed);
    samples.fundamental += std::polar(2.0 / n_samples, -2.0 * pi * i / n_samples) *
                           x.head(disc.n_modes()).cwiseQuotient(disc.omega);
    const SlidingDisc::Power power = motion.power(x);
    samples.energy.friction += step * power.friction;
    samples.energy.normal += step * power.normal;
    samples.energy.heat += step * power.heat;
    samples.energy.damping += step * power.damping;
    samples.energy.stored += 0.5 * x.squaredNorm() / n_samples;
    x = motion.advance(x, step, n_steps);
  }
  return samples;
}

/// The amplitudes along the modes of the body, turned in time so that the largest is real.
Eigen::VectorXcd body_amplitude(const InertialDisc& disc, const Eigen::VectorXcd& fundamental)
{
  const Eigen::VectorXcd amplitude = disc.R * fundamental;
  Eigen::Index largest = 0;
  const double modulus = amplitude.cwiseAbs().maxCoeff(&largest);
  return amplitude * (std::conj(amplitude[largest]) / modulus);
}

DirectLimitCycle measured(SlidingDisc& motion, const InertialDisc& inertial, const Cycle& cycle)
{
  const Orbit samples = orbit(motion, inertial, cycle);
  const Eigen::VectorXcd multipliers = floquet_multipliers(cycle.monodromy);
  return {.speed = motion.speed(),
          .frequency_Hz = 1.0 / cycle.at.period,
          .pad_velocity = std::max(peak(samples.z_dot), peak(-samples.z_dot)),
          .pad_displacement = 0.5 * (peak(samples.z) + peak(-samples.z)),
          .N_min = -peak(-samples.N),
          .N_max = peak(samples.N),
          .slip_speed_min = samples.slip_speed.minCoeff(),
          .multipliers = multipliers,
          .stable = (multipliers.tail(multipliers.size() - 1).cwiseAbs().array() < 1.0).all(),
          .n_newton_steps = cycle.n_newton_steps,
          .n_contact_evaluations = motion.n_evaluations(),
          .x = cycle.at.x,
          .mode_numbers = {},
          .amplitude = body_amplitude(inertial, samples.fundamental),
          .energy = samples.energy};
}

std::optional<DirectLimitCycle> find_and_measure(SlidingDisc& motion, const InertialDisc& inertial,
                                                 const SquealOptions& options,
                                                 const CycleStart& start)
{
  int steps_per_period = steps_per_period_min;
  std::optional<Cycle> cycle = find_cycle(motion, inertial, start, steps_per_period);
  while (cycle && error_along(*cycle) > multiplier_error &&
         steps_per_period < steps_per_period_max) {
    steps_per_period *= 2;
    cycle = find_cycle(motion, inertial, cycle->at, steps_per_period);
  }
  if (!cycle) return std::nullopt;
  const DirectLimitCycle found = measured(motion, inertial, *cycle);
  if (found.pad_displacement < rest * compression(options)) return std::nullopt;
  return found;
}

}  // namespace

DirectLimitCycle limit_cycle_direct(const Disc& disc, const SquealOptions& options, double speed)
{
  const InertialDisc inertial = inertial_disc(disc);
  const double growth = least_stable_eigenvalue(inertial, options, speed).real();
  if (!(growth > 0.0))
    throw Error(
        fmt::format("limit cycle: the sliding disc is stable at {:.6g} rad/s (largest growth rate "
                    "{:.3g} 1/s); a limit cycle grows from an unstable one",
                    speed, growth));
  SlidingDisc motion(inertial, options, speed);
  for (const double amplitude : start_amplitudes) {
    const CycleStart start =
        start_from_eigenvector(inertial, options, speed, amplitude * compression(options));
    if (auto cycle = find_and_measure(motion, inertial, options, start)) {
      cycle->mode_numbers = disc.mode_numbers;
      return *cycle;
    }
  }
  throw Error(
      fmt::format("limit cycle: Newton's method finds no periodic motion at {:.6g} rad/s; simulate "
                  "a transient instead",
                  speed));
}

std::optional<DirectLimitCycle> limit_cycle_near(const Disc& disc, const SquealOptions& options,
                                                 double speed, const CycleStart& start)
{
  const InertialDisc inertial = inertial_disc(disc);
  SlidingDisc motion(inertial, options, speed);
  auto cycle = find_and_measure(motion, inertial, options, start);
  if (cycle) cycle->mode_numbers = disc.mode_numbers;
  return cycle;
}

}  // namespace chladni::squeal
