#include "squeal/transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.hpp"
#include "squeal/contact_kick.hpp"
#include "squeal/growth_rate.hpp"
#include "squeal/inertial_frame.hpp"
#include "squeal/oscillator_flow.hpp"
#include "squeal/recorder.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

constexpr int steps_per_period_min = 8;
constexpr double steps_max = 1e10;
/// Periods of the lowest mode for one point of the envelope, and in the tail.
constexpr int periods_per_window = 4;
constexpr int periods_in_tail = 100;
constexpr std::int64_t history_points = 20000;
/// Pad displacement up to which growth is linear, relative to the compression of the pads at rest:
/// the first nonlinear term is quadratic and reaches about 1 % of the rate at 1.
constexpr double linear_part = 0.05;
/// Initial displacement for a growth rate, relative to the same.
constexpr double growth_start = 1e-4;

void check(const Disc& disc, const SquealOptions& options, const TransientCase& run)
{
  if (options.pads.empty()) throw Error("transient: no pads");
  if (!(run.speed > 0.0))
    throw Error(
        fmt::format("transient: speed_rad_s = {}; it must be > 0, since friction at rest has "
                    "no direction",
                    run.speed));
  if (!(run.duration > 0.0))
    throw Error(fmt::format("transient: duration_s = {}; it must be > 0", run.duration));
  if (!(run.initial_pad_displacement > 0.0))
    throw Error(fmt::format("transient: initial_pad_displacement = {}; it must be > 0",
                            run.initial_pad_displacement));
  if (run.steps_per_period < steps_per_period_min)
    throw Error(fmt::format(
        "transient: {} steps per period do not resolve the highest mode "
        "({:.0f} Hz); take at least {}, better 40",
        run.steps_per_period, disc.omega.maxCoeff() / (2.0 * pi), steps_per_period_min));
}

RecordingPlan plan_of(const Disc& disc, const TransientCase& run)
{
  const double step = 2.0 * pi / (disc.omega.maxCoeff() * run.steps_per_period);
  const double n_steps = std::ceil(run.duration / step);
  if (!(n_steps < steps_max))
    throw Error(fmt::format("transient: {} s take {:.1e} steps (allowed: {:.0e})", run.duration,
                            n_steps, steps_max));
  const double steps_of_period = 2.0 * pi / (disc.omega.minCoeff() * step);
  const auto n = static_cast<std::int64_t>(n_steps);
  const auto tail = static_cast<std::int64_t>(periods_in_tail * steps_of_period);
  return {.step = step,
          .n_steps = n,
          .window = static_cast<std::int64_t>(periods_per_window * steps_of_period),
          .every = std::max<std::int64_t>(1, n / history_points),
          .n_tail = std::min(n, tail)};
}

/// a_cos = a_sin in the first pair, turned so that the crest of the cosine is at `angle`; at rest
/// in the inertial frame, i.e. a' = 0, p = Omega D a.
ModalState start_in_first_pair(const InertialDisc& disc, const TransientCase& run, double angle)
{
  Eigen::VectorXd a = Eigen::VectorXd::Zero(disc.n_modes());
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < disc.n_modes(); ++i)
    if (disc.nodal_diameters[static_cast<std::size_t>(i)] > 0 &&
        (disc.nodal_diameters[static_cast<std::size_t>(first)] == 0 ||
         disc.omega[i] < disc.omega[first]))
      first = i;
  const bool pair = disc.nodal_diameters[static_cast<std::size_t>(first)] > 0;
  a.segment(first, pair ? 2 : 1).setConstant(run.initial_pad_displacement / disc.U[first]);
  const Eigen::VectorXd at_pad = turned(disc, a, angle);
  return {disc.R * at_pad, disc.R * (run.speed * disc.D * at_pad)};
}

ModalState initial_state(const Disc& disc, const std::optional<InertialDisc>& inertial,
                         const TransientCase& run, double angle)
{
  if (inertial) return start_in_first_pair(*inertial, run, angle);
  const Eigen::VectorXd W = shapes_at(disc, angle).W;
  return {W * (run.initial_pad_displacement / W.squaredNorm()),
          Eigen::VectorXd::Zero(disc.n_modes())};
}

double rest_compression(const SquealOptions& options)
{
  return options.pads.front().preload / options.pads.front().stiffness;
}

/// q of the tail, column by column, in the inertial frame but along the modes of the body.
Eigen::MatrixXd in_inertial_frame(const InertialDisc& inertial, const Eigen::MatrixXd& q,
                                  const std::vector<double>& t, double speed)
{
  Eigen::MatrixXd a(q.rows(), static_cast<Eigen::Index>(t.size()));
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    a.col(j) = inertial.R * turned(inertial, inertial.R.transpose() * q.col(j),
                                   speed * t[static_cast<std::size_t>(j)]);
  return a;
}

}  // namespace

Transient transient(const Disc& disc, const SquealOptions& options, const TransientCase& run,
                    const Progress& progress)
{
  check(disc, options, run);
  const RecordingPlan plan = plan_of(disc, run);
  const std::optional<InertialDisc> inertial = find_inertial_disc(disc);
  const OscillatorFlow whole_step(disc.omega, disc.C, plan.step);
  ContactKick kick(disc, options, run.speed);
  Recorder recorder(plan, 0.5 * options.thickness);
  Eigen::MatrixXd tail_q(disc.n_modes(), plan.n_tail);

  ModalState x = initial_state(disc, inertial, run, options.pads.front().angle);
  OscillatorFlow(disc.omega, disc.C, 0.5 * plan.step).advance(x);
  bool finite = true;
  for (std::int64_t i = 0; i < plan.n_steps && finite; ++i) {
    // The two half flows between two kicks are one; all results are those of the kick, which
    // the splitting leaves symmetric in time.
    const double t = (double(i) + 0.5) * plan.step;
    if (recorder.in_tail(i)) tail_q.col(i - (plan.n_steps - plan.n_tail)) = x.q;
    const auto& contacts = kick.apply(x, t, plan.step);
    finite = x.v.allFinite();
    if (finite) recorder.add(i, t, contacts);
    whole_step.advance(x);
    if (progress && i % plan.window == 0) progress(double(i) / double(plan.n_steps));
  }

  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = finite;
  result.growth_rate = growth_rate(result.envelope, linear_part * rest_compression(options));
  if (inertial) result.tail_a = in_inertial_frame(*inertial, tail_q, result.tail.t, run.speed);
  return result;
}

Growth growth(const Disc& disc, const SquealOptions& options, double speed, double duration)
{
  const double compression = rest_compression(options);
  const Transient run = transient(disc, options,
                                  {.speed = speed,
                                   .duration = duration,
                                   .initial_pad_displacement = growth_start * compression});
  if (!run.growth_rate)
    throw Error(
        fmt::format("growth: {} s at {} rad/s are too short for a growth rate; simulate at "
                    "least {:.2g} s",
                    duration, speed, 200.0 * pi / disc.omega.minCoeff()));
  Growth result{speed, run.envelope, *run.growth_rate, std::nullopt};
  if (const auto inertial = find_inertial_disc(disc))
    result.eigenvalue_rate = least_stable_eigenvalue(*inertial, options, speed).real();
  return result;
}

}  // namespace chladni::squeal
