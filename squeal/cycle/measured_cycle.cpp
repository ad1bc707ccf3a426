#include "squeal/cycle/measured_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/pad_amplitudes.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/sliding_disc.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Points of the cycle from which peaks, amplitudes and energies are taken: a parabola through
/// three of them misses the peak of a sine by 1e-8.
constexpr int n_samples = 256;
/// Of two of these parts, for the lowest speed of sliding.
constexpr int n_finer = 40;

/// What the first pad pair does during one period.
struct PadSamples {
  Eigen::VectorXd z{n_samples}, z_dot{n_samples}, N{n_samples}, slip_speed{n_samples};

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
  const CycleStart about{states.col((i + n_samples - 1) % n_samples),
                         2.0 * orbit.at.period / n_samples};
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
  const Eigen::MatrixXd states = states_over_period(motion, orbit.at, n_samples, orbit.tolerance);
  const Eigen::Index n = disc.n_modes();
  PadSamples pad;
  CycleEnergy energy = no_energy(motion.n_pads());
  Eigen::VectorXcd fundamental = Eigen::VectorXcd::Zero(n);
  const double step = orbit.at.period / n_samples;
  for (int i = 0; i < n_samples; ++i) {
    const auto x = states.col(i);
    const SlidingDisc::Sample now = motion.sample(x);
    pad.set(i, now.first);
    energy.friction += step * now.power.friction;
    energy.normal += step * now.power.normal;
    energy.damping += step * now.power.damping;
    energy.heat += step * now.power.heat;
    energy.stored += 0.5 * x.squaredNorm() / n_samples;
    fundamental += std::polar(2.0 / n_samples, -2.0 * pi * i / n_samples) *
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
  const Eigen::MatrixXd states = states_over_period(motion, orbit.at, n_samples, orbit.tolerance);
  PadSamples pad;
  for (int i = 0; i < n_samples; ++i) pad.set(i, motion.first_contact(states.col(i)));
  DirectLimitCycle cycle = seen_at_pad(pad, orbit, speed);
  cycle.slip_speed_min = lowest_slip(motion, pad, states, orbit);
  cycle.n_contact_evaluations = motion.n_evaluations();
  return cycle;
}

}  // namespace chladni::squeal
