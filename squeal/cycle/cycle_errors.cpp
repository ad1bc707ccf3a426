#include "squeal/cycle/cycle_errors.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/error_budget.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

/// Where the modes of `few` are among those of `all`: [n_all x n_few] of zeros and ones.
Eigen::MatrixXd selection(const Disc& few, const Disc& all)
{
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(all.n_modes(), few.n_modes());
  for (Eigen::Index j = 0; j < few.n_modes(); ++j) {
    const auto at =
        std::ranges::find(all.mode_numbers, few.mode_numbers[static_cast<std::size_t>(j)]);
    if (at != all.mode_numbers.end()) S(at - all.mode_numbers.begin(), j) = 1.0;
  }
  return S;
}

/// The states of a brake with some modes of a body as states of the same brake with all of them,
/// where the modes left out do not move.
/// @param x  [size of `few` x n]
/// @return [size of `all` x n]
Eigen::MatrixXd with_all_modes(const FlexibleDisc& few, const FlexibleDisc& all,
                               const Eigen::MatrixXd& x)
{
  const InertialDisc &a = few.inertial(), &b = all.inertial();
  // q = R a in both, and the columns of R are orthonormal.
  const Eigen::MatrixXd P = b.R.transpose() * selection(few.disc(), all.disc()) * a.R;
  const Eigen::Index n_few = a.n_modes(), n_all = b.n_modes(), half = x.rows() / 2,
                     n_pads = half - n_few, whole = n_all + n_pads;
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(2 * whole, x.cols());
  const Eigen::MatrixXd by_omega = a.omega.cwiseInverse().asDiagonal() * x.topRows(n_few);
  y.topRows(n_all) = b.omega.asDiagonal() * (P * by_omega);
  y.middleRows(n_all, n_pads) = x.middleRows(n_few, n_pads);
  y.middleRows(whole, n_all) = P * x.middleRows(half, n_few);
  y.bottomRows(n_pads) = x.bottomRows(n_pads);
  return y;
}

/// Of the sharper cycle: twice as many as those of the cycle.
constexpr int n_sharp_samples = 512;
/// Of the forces, for derivatives of the cycle.
constexpr int samples_of_errors = 128;
constexpr int n_harmonics_min = 3, n_harmonics_max = 12;
/// Equations of the harmonic balance, which are solved densely, up to which there are more than the
/// fewest harmonics.
constexpr Eigen::Index n_equations = 800;
/// Most of them that are solved for the modes left out.
constexpr Eigen::Index n_equations_max = 4000;
/// Of two cycles whose difference counts.
constexpr HarmonicResolution compared{
    .n_harmonics = n_harmonics_min, .n_samples = 64, .tolerance = 1e-8};
constexpr double states_tolerance = 1e-9;
/// Relative; f is piecewise smooth, so that central differences leave its square.
constexpr double relative_change = 1e-5;

/// What is told with its error.
constexpr std::array<ErrorBudget CycleErrors::*, 3> told{
    &CycleErrors::frequency_Hz, &CycleErrors::pad_velocity, &CycleErrors::pad_displacement};

/// Displacement and velocity of the first upper pad.
struct PadMotion {
  Eigen::VectorXd z, z_dot;
};

PadMotion pad_motion(AutonomousMotion& motion, const Eigen::MatrixXd& states)
{
  PadMotion pad{Eigen::VectorXd(states.cols()), Eigen::VectorXd(states.cols())};
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const ContactResult<double> contact = motion.first_contact(states.col(i));
    pad.z[i] = contact.upper.z;
    pad.z_dot[i] = contact.upper.z_dot;
  }
  return pad;
}

/// The errors of frequency, velocity and displacement; absent when no sharper cycle is found.
std::optional<Eigen::Vector3d> errors_by_integration(AutonomousMotion& motion,
                                                     const DirectLimitCycle& cycle)
{
  const auto at = sharper_start(motion, {cycle.x, 1.0 / cycle.frequency_Hz});
  if (!at) return std::nullopt;
  const PadMotion pad =
      pad_motion(motion, states_over_period(motion, *at, n_sharp_samples, sharp_tolerance));
  const PadAmplitudes amplitudes = pad_amplitudes(pad.z, pad.z_dot);
  return Eigen::Vector3d(1.0 / at->period - cycle.frequency_Hz,
                         amplitudes.velocity - cycle.pad_velocity,
                         amplitudes.displacement - cycle.pad_displacement)
      .cwiseAbs();
}

/// How a limit cycle changes with the disc.
class ChangingCycle {
 public:
  ChangingCycle(const FlexibleDisc& brake, AutonomousMotion& motion, const DirectLimitCycle& cycle)
      : brake_(brake),
        speed_(cycle.speed),
        balance_(motion, series_near(motion, cycle), samples_of_errors),
        pad_(pad_motion(motion, samples_of(balance_.at(), samples_of_errors)))
  {}

  /// Of frequency, velocity and displacement by the logarithm of what is scaled, [3].
  Eigen::VectorXd by(const DiscScaling& scale) const
  {
    const std::unique_ptr<SlidingDisc> more = scaled(scale, 1.0 + relative_change),
                                       less = scaled(scale, 1.0 - relative_change);
    const HarmonicCycle change = balance_.change(*more, *less, 2.0 * relative_change);
    const PadMotion at_more = pad_after(*more, change, relative_change),
                    at_less = pad_after(*less, change, -relative_change);
    const Eigen::VectorXd z = (at_more.z - at_less.z) / (2.0 * relative_change),
                          z_dot = (at_more.z_dot - at_less.z_dot) / (2.0 * relative_change);
    const double velocity = peak(pad_.z_dot) > peak(-pad_.z_dot) ? peak_change(pad_.z_dot, z_dot)
                                                                 : peak_change(-pad_.z_dot, -z_dot);
    const double stroke = peak_change(pad_.z, z) + peak_change(-pad_.z, -z);
    return Eigen::Vector3d(change.omega / (2.0 * pi), velocity, 0.5 * stroke);
  }

 private:
  static HarmonicCycle series_near(AutonomousMotion& motion, const DirectLimitCycle& cycle)
  {
    const Eigen::Index affordable = (n_equations / motion.size() - 1) / 2;
    const int n_harmonics =
        std::clamp(static_cast<int>(affordable), n_harmonics_min, n_harmonics_max);
    const Eigen::MatrixXd states = states_over_period(motion, {cycle.x, 1.0 / cycle.frequency_Hz},
                                                      samples_of_errors, states_tolerance);
    return series_of(states, 2.0 * pi * cycle.frequency_Hz, n_harmonics);
  }

  std::unique_ptr<SlidingDisc> scaled(const DiscScaling& scale, double factor) const
  {
    InertialDisc disc = brake_.inertial();
    scale(disc, factor);
    return std::make_unique<SlidingDisc>(disc, brake_.options(), speed_);
  }

  PadMotion pad_after(AutonomousMotion& motion, const HarmonicCycle& change, double by) const
  {
    return pad_motion(motion,
                      samples_of({balance_.at().X + by * change.X, 0.0}, samples_of_errors));
  }

  const FlexibleDisc& brake_;
  double speed_;
  LinearBalance balance_;
  PadMotion pad_;
};

/// Frequency, velocity and displacement of a cycle by a few harmonics; absent when none is found.
std::optional<Eigen::Vector3d> balanced_numbers(AutonomousMotion& motion, const HarmonicCycle& near)
{
  const auto cycle = harmonic_balance(motion, near, compared);
  if (!cycle) return std::nullopt;
  const PadMotion pad = pad_motion(motion, samples_of(*cycle, samples_of_errors));
  const PadAmplitudes amplitudes = pad_amplitudes(pad.z, pad.z_dot);
  return Eigen::Vector3d(cycle->omega / (2.0 * pi), amplitudes.velocity, amplitudes.displacement);
}

/// The differences to the cycle near this one with all modes of the body, both by a few harmonics;
/// absent when all take part already or there is none.
std::optional<Eigen::Vector3d> errors_by_modes_left_out(const FlexibleDisc& brake,
                                                        AutonomousMotion& motion,
                                                        const DirectLimitCycle& cycle)
{
  const FlexibleDisc* all = brake.complete();
  if (!all || !all->is_autonomous()) return std::nullopt;
  const std::unique_ptr<AutonomousMotion> motion_of_all = all->motion(cycle.speed);
  if (motion_of_all->size() * (2 * compared.n_harmonics + 1) > n_equations_max) return std::nullopt;
  const Eigen::MatrixXd states = states_over_period(motion, {cycle.x, 1.0 / cycle.frequency_Hz},
                                                    samples_of_errors, states_tolerance);
  const auto near = [&cycle](const Eigen::MatrixXd& x) {
    return series_of(x, 2.0 * pi * cycle.frequency_Hz, compared.n_harmonics);
  };
  const auto of_few = balanced_numbers(motion, near(states));
  if (!of_few) return std::nullopt;
  const auto of_all = balanced_numbers(*motion_of_all, near(with_all_modes(brake, *all, states)));
  if (!of_all) return std::nullopt;
  return (*of_all - *of_few).cwiseAbs();
}

/// Whether anything is known of the errors of modes.
bool knows_errors(const ModeErrors& errors)
{
  return errors.mesh.size() > 0 || errors.reduction.size() > 0 || errors.responses;
}

}  // namespace

CycleErrors cycle_errors(const Brake& brake, const DirectLimitCycle& cycle)
{
  CycleErrors errors;
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(cycle.speed);
  const FlexibleDisc* body = brake.body();
  if (body && knows_errors(body->inertial().errors)) {
    const ChangingCycle changing(*body, *motion, cycle);
    const ErrorsByModes by_modes =
        errors_by_modes(body->inertial(), 2.0 * pi * cycle.frequency_Hz, std::ssize(told),
                        [&](const DiscScaling& scale) { return changing.by(scale); });
    for (std::size_t i = 0; i < told.size(); ++i)
      errors.*told[i] = by_modes.budget(static_cast<Eigen::Index>(i));
  }
  if (body) {
    if (const auto left_out = errors_by_modes_left_out(*body, *motion, cycle))
      for (std::size_t i = 0; i < told.size(); ++i)
        (errors.*told[i]).left_out = (*left_out)[static_cast<Eigen::Index>(i)];
  }
  if (const auto by_integration = errors_by_integration(*motion, cycle))
    for (std::size_t i = 0; i < told.size(); ++i)
      (errors.*told[i]).integration = (*by_integration)[static_cast<Eigen::Index>(i)];
  return errors;
}

}  // namespace chladni::squeal
