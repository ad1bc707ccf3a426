#include "squeal/transient/transient.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/told_apart.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "linear/dense/eigenmodes.hpp"
#include "squeal/brake/contact.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/resampling.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {

using std::numbers::pi;

namespace {

/// A transient that is ready to start.
struct PreparedTransient {
  RecordingPlan plan;
  std::string integrator;  ///< name as in the scene
  std::string reason;      ///< reason of the choice, for the user
  double rest_height;      ///< height z of the first upper pad at rest, m
  double first_sample;     ///< time of the first sample divided by the sampling step
  std::unique_ptr<TransientSteps> steps;
  std::optional<TailRecorder> tail;  ///< for a brake with a body; reads `modal`
  const ModalSteps* modal;           ///< the steps of a brake with a body, else null
};

/// Each point of the programs lies in the tables of friction.
void check_tables(const PadSystem& pads, const TransientCase& run)
{
  std::vector<double> speeds{run.speed}, preloads{1.0};
  for (const SpeedPoint& point : run.speed_program) speeds.push_back(point.speed);
  for (const PreloadPoint& point : run.preload_program) preloads.push_back(point.factor);
  if (!run.preload_program.empty()) preloads.erase(preloads.begin());
  for (const PointPair& point : pads.points)
    for (const double speed : speeds)
      for (const double preload : preloads) {
        PadContact contact = point.contact;
        contact.preload *= preload;
        require_in_table(contact, speed);
      }
}

void check_speed_program(const FrictionLaw& friction, const TransientCase& run)
{
  const bool stops = std::ranges::any_of(
      run.speed_program, [](const SpeedPoint& point) { return !(point.speed > 0.0); });
  if (stops && !(friction.regularisation > 0.0)) {
    throw Error(
        "transient: the speed program comes to rest, where friction has no direction; give "
        "friction a regularisation, e.g. friction = { kinetic = 0.6, regularisation = 1e-3 }");
  }
}

/// Samples of one period of the highest mode.
int sampling_of(const IntegratorChoice& choice)
{
  const bool fixed =
      choice.kind == IntegratorKind::splitting || choice.kind == IntegratorKind::exponential;
  return fixed ? choice.steps_per_period : samples_per_period;
}

/// Of the modes; the highest also of light plates beside the springs of their linings, from the
/// symmetric part of the stiffness in one position of the disc.
FrequencyRange frequencies_of(const Disc& disc, const SquealOptions& options, double speed)
{
  const ContactKick kick(disc, options, speed);
  const FreeBrake brake = free_brake(disc, kick.pads(), speed);
  FrequencyRange range{.lowest = disc.omega.minCoeff(), .highest = brake.omega.maxCoeff()};
  if (kick.pads().n_modes() == 0) return range;
  const Eigen::MatrixXd K =
      brake.omega.cwiseAbs2().asDiagonal().toDenseMatrix() + kick.contact_stiffness();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
      Eigen::MatrixXd(0.5 * (K + K.transpose())), Eigen::EigenvaluesOnly);
  range.highest = std::max(range.highest, std::sqrt(modes.eigenvalues().maxCoeff()));
  return range;
}

/// Of the eigenvalues about the sliding equilibrium.
FrequencyRange frequencies_of(const Brake& brake, double speed)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(brake.state_matrix(speed));
  const double highest = lambda.cwiseAbs().maxCoeff();
  double lowest = highest;
  for (const std::complex<double>& value : lambda)
    if (value.imag() > 0.0) lowest = std::min(lowest, value.imag());
  return {.lowest = lowest, .highest = highest};
}

PreparedTransient prepared_with_body(const FlexibleDisc& brake, const TransientCase& run)
{
  const Disc& disc = brake.disc();
  const SquealOptions& options = brake.options();
  if (options.pads.empty()) throw Error("transient: no pads");
  check_transient(run, disc.omega.maxCoeff());
  check_speed_program(options.friction, run);
  for (const PadPair& pad : options.pads)
    if (pad.friction) check_speed_program(*pad.friction, run);
  check_tables(pad_system(options, ring_places(disc)), run);
  const std::optional<InertialDisc>& inertial = brake.find_inertial();
  const IntegratorChoice choice = choose_integrator(disc, inertial, options, run);
  const RecordingPlan plan =
      recording_plan(run, frequencies_of(disc, options, run.speed), sampling_of(choice));
  auto steps = transient_steps(disc, options, run, choice, plan.step,
                               transient_start(disc, inertial, run, options.pads.front().angle));
  const ModalSteps* const modal = steps.get();
  return {.plan = plan,
          .integrator = name_of(choice.kind),
          .reason = choice.reason,
          .rest_height = 0.5 * options.thickness,
          .first_sample = 0.5,
          .steps = std::move(steps),
          .tail = TailRecorder(disc, inertial, plan, run),
          .modal = modal};
}

PreparedTransient prepared_lumped(const LumpedBrake& brake, const TransientCase& run)
{
  if (run.integrator != IntegratorKind::automatic &&
      run.integrator != IntegratorKind::dormand_prince)
    throw Error(
        "transient: a model without a body has the integrator \"dormand-prince\" alone; leave "
        "integrator out");
  if (!run.is_constant()) {
    throw Error(
        "transient: a model without a body turns at a constant speed and preload; leave "
        "speed_program and preload_program out");
  }
  const RecordingPlan plan = recording_plan(run, frequencies_of(brake, run.speed),
                                            run.steps_per_period.value_or(lumped_steps_per_period));
  return {.plan = plan,
          .integrator = name_of(IntegratorKind::dormand_prince),
          .reason = "of order 8 with fixed steps, for models without a body",
          .rest_height = brake.rest_height(),
          .first_sample = 0.0,
          .steps = std::make_unique<LumpedSteps>(brake, run, plan.step),
          .tail = std::nullopt,
          .modal = nullptr};
}

/// Prepares a transient.
/// @param brake, run  must outlive the result
/// @throws chladni::Error as `transient`.
PreparedTransient prepared_transient(const Brake& brake, const TransientCase& run)
{
  if (const FlexibleDisc* body = brake.body()) return prepared_with_body(*body, run);
  if (const LumpedBrake* lumped = brake.lumped()) return prepared_lumped(*lumped, run);
  throw Error(
      "transient: this brake has neither a modal body nor equations of first order; look for its "
      "limit cycles directly");
}

/// Lowest angular frequency of small motions of the brake at a speed (rad/s), rad/s.
double lowest_frequency(const Brake& brake, double speed)
{
  if (const FlexibleDisc* body = brake.body()) return body->disc().omega.minCoeff();
  return frequencies_of(brake, speed).lowest;
}

/// Growth of the least stable motion, 1/s; absent where the brake has no state matrix.
std::optional<double> eigenvalue_growth(const Brake& brake, double speed)
{
  if (!brake.is_autonomous()) return std::nullopt;
  return least_stable_eigenvalue(brake.state_matrix(speed)).real();
}

/// Sliding so slow that its direction turns within a step of an explicit kick, m/s, without
/// regularisation, and with it in multiples of that.
constexpr double slow_sliding = 1e-2, slow_multiple = 10.0;

std::string warning_of_sliding(const Transient& run, const SquealOptions& options)
{
  const FrictionLaw law = options.pads.front().friction.value_or(options.friction);
  const double eps = law.regularisation;
  const double limit = eps > 0.0 ? slow_multiple * eps : slow_sliding;
  if (run.slip_speed_min >= limit || law.kinetic == 0.0 ||
      run.integrator == name_of(IntegratorKind::generalised_alpha))
    return {};
  return fmt::format(
      "sliding fell to {:.2g} m/s, {}; compare with integrator = \"generalised-alpha\"",
      run.slip_speed_min,
      eps > 0.0 ? "where the regularisation of friction counts"
                : "where the direction of friction turns at once: give friction a regularisation");
}

std::string warning_of(const Transient& run, const Brake& brake)
{
  const FlexibleDisc* const body = brake.body();
  const std::string sliding = body ? warning_of_sliding(run, body->options()) : std::string();
  if (!run.growth_rate || !brake.is_autonomous()) return sliding;
  const std::string growth =
      warning_of_growth(*run.growth_rate, eigenvalue_growth(brake, run.speed).value());
  return sliding.empty() || growth.empty() ? sliding + growth : sliding + "; " + growth;
}

bool is_bounded(const PadState<double>& pad)
{
  const auto is_number = [](double x) { return std::abs(x) < motion_max; };
  return is_number(pad.z) && is_number(pad.z_dot) && is_number(pad.N) && is_number(pad.slip_speed);
}

bool is_bounded(const std::vector<ContactResult<double>>& contacts)
{
  return std::ranges::all_of(contacts, [](const ContactResult<double>& pair) {
    return is_bounded(pair.upper) && is_bounded(pair.lower);
  });
}

/// A run under way.
struct Recording {
  PreparedTransient& ready;
  const TransientCase& run;
  Recorder recorder;
  std::optional<Resampler> sound = {};
};

/// Samples of the sound that go to its file together.
constexpr std::size_t samples_together = 1024;

/// @return whether the motion stayed bounded
bool record(Recording& at, const Keeping& keeping)
{
  const RecordingPlan& plan = at.ready.plan;
  for (std::int64_t i = 0; i < plan.n_steps; ++i) {
    const double t = (double(i) + at.ready.first_sample) * plan.step;
    const auto& contacts = at.ready.steps->next();
    if (!is_bounded(contacts)) return false;
    at.recorder.add({i, t, turn_at(at.run, t).speed, contacts});
    if (at.ready.tail) at.ready.tail->add(i, t, *at.ready.modal);
    if (at.sound) at.sound->add(contacts.front().upper.z_dot);
    if (keeping.progress && i % plan.window == 0)
      keeping.progress(double(i) / double(plan.n_steps));
    if (at.sound && at.sound->n_waiting() >= samples_together) keeping.sound->add(at.sound->take());
  }
  return true;
}

/// What was recorded of the run, and what the steps know of it.
Transient result_of(const Recording& recording)
{
  const PreparedTransient& ready = recording.ready;
  Transient result = recording.recorder.transient();
  result.speed = recording.run.speed;
  result.integrator = ready.integrator;
  result.integrator_reason = ready.reason;
  result.n_steps = ready.steps->n_steps();
  result.n_contact_evaluations = ready.steps->n_contact_evaluations();
  result.n_events = ready.steps->n_events();
  result.events = ready.steps->events();
  if (ready.tail) result.tail_a = ready.tail->tail_a();
  return result;
}

}  // namespace

Transient transient(const Brake& brake, const TransientCase& run, const Keeping& keeping)
{
  PreparedTransient ready = prepared_transient(brake, run);
  Recording recording{.ready = ready, .run = run, .recorder = {ready.plan, ready.rest_height}};
  if (keeping.sound) recording.sound.emplace(ready.plan.step, keeping.sound->rate_Hz());
  const bool bounded = record(recording, keeping);
  recording.recorder.finish();
  Transient result = result_of(recording);
  result.finished = bounded;
  if (const FlexibleDisc* body = brake.body()) result.mode_numbers = body->disc().mode_numbers;
  if (run.is_constant())
    result.growth_rate = growth_rate(result.envelope, linear_part * brake.rest_compression());
  else
    result.speed = turn_at(run, run.duration).speed;
  result.warning = warning_of(result, brake);
  if (recording.sound) {
    recording.sound->finish();
    keeping.sound->add(recording.sound->take());
    keeping.sound->finish();
  }
  return result;
}

Growth growth(const Brake& brake, double speed, double duration)
{
  const Transient run = transient(brake, growth_case(speed, duration, brake.rest_compression()));
  return {.speed = speed,
          .envelope = run.envelope,
          .rate = required_growth_rate(run, duration, lowest_frequency(brake, speed)),
          .eigenvalue_rate = eigenvalue_growth(brake, speed)};
}

std::string divergence_of(const Transient& run)
{
  const double t = run.history.t.empty() ? 0.0 : run.history.t.back();
  return fmt::format(
      "the motion diverged after {:.3g} s; damping or the contact law do not bound it", t);
}

namespace {

constexpr double steps_of_run_max = 1e10;
/// What no brake vibrates with, and the steps that still take little time then.
constexpr double absurd_Hz = 1e7, bearable_steps = 1e7;
/// Periods of the lowest mode for one point of the envelope, and in the tail.
constexpr int periods_per_window = 4;
constexpr int periods_in_tail = 100;
/// Most samples of the history: 10 MB. 6 s of them hold what is below 12 kHz.
constexpr std::int64_t history_max = 200000;
/// Most points of the envelope, the first half of them of a few periods: a growth rate is read
/// there.
constexpr std::int64_t windows_max = 20000;
/// Most samples of the tail: 12 MB, and 2.4 MB for each mode.
constexpr std::int64_t tail_max = 300000;
/// Initial displacement for a growth rate, relative to the compression of the pads at rest.
constexpr double growth_start = 1e-4;

/// Steps of each of at most `n_parts` parts.
std::int64_t parts_of(std::int64_t n_steps, std::int64_t n_parts)
{
  return (n_steps - 1) / n_parts + 1;
}

/// Numbers of other units make bodies so stiff or light that their transients hardly end.
void check_steps(const TransientCase& run, double n_steps, double omega_highest)
{
  const double highest_Hz = omega_highest / (2.0 * pi);
  const bool is_absurd = highest_Hz > absurd_Hz;
  if (n_steps < (is_absurd ? bearable_steps : steps_of_run_max)) return;
  constexpr double steps_per_hour = 3.6e9;  // of two modes on one core
  const auto [steps, allowed] = told_apart(n_steps, is_absurd ? bearable_steps : steps_of_run_max);
  throw Error(
      fmt::format("transient: {} s take {} steps (allowed: {}), hours: {:.1g} or more, "
                  "since the highest mode has {:.2g} Hz; {}",
                  run.duration, steps, allowed, n_steps / steps_per_hour, highest_Hz,
                  is_absurd ? "no brake has: is the density in kg/m^3 and Young's modulus in Pa?"
                            : "simulate less, or keep fewer modes"));
}

}  // namespace

void check_transient(const TransientCase& run, double omega_highest)
{
  if (!(run.speed > 0.0)) {
    throw Error(
        fmt::format("transient: speed_rad_s = {}; it must be > 0, since friction at rest has "
                    "no direction",
                    run.speed));
  }
  if (!(run.duration > 0.0))
    throw Error(fmt::format("transient: duration_s = {}; it must be > 0", run.duration));
  if (!(run.initial_pad_displacement > 0.0)) {
    throw Error(fmt::format("transient: initial_pad_displacement = {}; it must be > 0",
                            run.initial_pad_displacement));
  }
  if (run.steps_per_period && *run.steps_per_period < steps_per_period_min) {
    throw Error(fmt::format(
        "transient: {} steps per period do not resolve the highest mode ({:.0f} Hz); take at least "
        "{}, better leave steps_per_period out",
        *run.steps_per_period, omega_highest / (2.0 * pi), steps_per_period_min));
  }
}

RecordingPlan recording_plan(const TransientCase& run, const FrequencyRange& omega, int samples)
{
  check_transient(run, omega.highest);
  const double step = 2.0 * pi / (omega.highest * samples);
  const double n_steps = std::ceil(run.duration / step);
  check_steps(run, n_steps, omega.highest);
  const double steps_of_period = 2.0 * pi / (omega.lowest * step);
  const auto n = static_cast<std::int64_t>(n_steps);
  const auto tail = static_cast<std::int64_t>(periods_in_tail * steps_of_period);
  const auto window = static_cast<std::int64_t>(periods_per_window * steps_of_period);
  const std::int64_t n_fine = windows_max / 2;
  const std::int64_t n_behind = std::max<std::int64_t>(1, n - n_fine * window);
  return {.step = step,
          .n_steps = n,
          .window = window,
          .n_fine_windows = n_fine,
          .late_window = std::max(window, parts_of(n_behind, windows_max - n_fine)),
          .history = decimation_to(n, history_max),
          .n_tail = std::min({n, tail, tail_max})};
}

TransientCase growth_case(double speed, double duration, double compression)
{
  return {
      .speed = speed, .duration = duration, .initial_pad_displacement = growth_start * compression};
}

double required_growth_rate(const Transient& run, double duration, double omega_lowest)
{
  if (run.growth_rate) return *run.growth_rate;
  const double least = 200.0 * pi / omega_lowest;
  if (duration >= least) {
    throw Error(
        fmt::format("growth: at {} rad/s the motion is small for too short a time to measure a "
                    "growth rate; use the analysis \"eigenvalues\"",
                    run.speed));
  }
  throw Error(
      fmt::format("growth: {} s at {} rad/s are too short for a growth rate; simulate at "
                  "least {:.2g} s",
                  duration, run.speed, least));
}

std::optional<double> growth_rate(const Envelope& envelope, double linear_limit)
{
  const auto& z = envelope.pad_displacement;
  const auto end = std::ranges::find_if(z, [&](double x) { return x > linear_limit; });
  const Eigen::Index n_linear = end - z.begin(), first = n_linear / 2, n = n_linear - first;
  if (n < 8) return std::nullopt;
  const Eigen::Map<const Eigen::ArrayXd> t(envelope.t.data() + first, n);
  const Eigen::Map<const Eigen::ArrayXd> v(envelope.pad_velocity.data() + first, n);
  if (!(v.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::ArrayXd x = t - t.mean();
  return (x * v.log()).sum() / x.square().sum();
}

double told_rate(const Growth& growth)
{
  return growth.eigenvalue_rate.value_or(growth.rate);
}

bool disagree(double measured, double of_eigenvalue)
{
  return std::abs(measured - of_eigenvalue) > std::max(0.1 * std::abs(of_eigenvalue), 0.01);
}

std::string warning_of_growth(double measured, double of_eigenvalue)
{
  if (!disagree(measured, of_eigenvalue)) return {};
  return fmt::format(
      "its growth of {:.4g} 1/s is not that of the least stable motion, {:.4g} 1/s by the "
      "eigenvalues: other motions still prevail; simulate for longer",
      measured, of_eigenvalue);
}

}  // namespace chladni::squeal
