#include "squeal/transient/transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/contact_kick.hpp"
#include "squeal/motion/speed_program.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/transient/growth_rate.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/resampler.hpp"
#include "squeal/transient/snapshot_recorder.hpp"
#include "squeal/transient/transient_plan.hpp"
#include "squeal/transient/transient_start.hpp"
#include "squeal/transient/transient_steps.hpp"

namespace chladni::squeal {
namespace {

void check_speed_program(const SquealOptions& options, const TransientCase& run)
{
  const bool stops = std::any_of(run.speed_program.begin(), run.speed_program.end(),
                                 [](const SpeedPoint& point) { return !(point.speed > 0.0); });
  if (stops && !(options.friction.regularisation > 0.0))
    throw Error(
        "transient: the speed program comes to rest, where friction has no direction; give "
        "friction a regularisation, e.g. friction = { kinetic = 0.6, regularisation = 1e-3 }");
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

double rest_compression(const SquealOptions& options)
{
  return options.pads.front().preload / options.pads.front().stiffness;
}

/// Sliding so slow that its direction turns within a step of an explicit kick, m/s, without
/// regularisation, and with it in multiples of that.
constexpr double slow_sliding = 1e-2, slow_multiple = 10.0;

std::string warning_of_sliding(const Transient& run, const SquealOptions& options)
{
  const double eps = options.friction.regularisation;
  const double limit = eps > 0.0 ? slow_multiple * eps : slow_sliding;
  if (run.slip_speed_min >= limit || options.friction.kinetic == 0.0 ||
      run.integrator == name_of(IntegratorKind::generalised_alpha))
    return {};
  return fmt::format(
      "sliding fell to {:.2g} m/s, {}; compare with integrator = \"generalised-alpha\"",
      run.slip_speed_min,
      eps > 0.0 ? "where the regularisation of friction counts"
                : "where the direction of friction turns at once: give friction a regularisation");
}

std::string warning_of(const Transient& run, const Disc& disc, const SquealOptions& options)
{
  const std::string sliding = warning_of_sliding(run, options);
  const auto inertial = find_inertial_disc(disc);
  if (!run.growth_rate || !inertial) return sliding;
  const std::string growth = warning_of_growth(
      *run.growth_rate, least_stable_eigenvalue(*inertial, options, run.speed).real());
  return sliding.empty() || growth.empty() ? sliding + growth : sliding + "; " + growth;
}

bool is_bounded(const PadState<double>& pad)
{
  const auto is_number = [](double x) { return std::abs(x) < motion_max; };
  return is_number(pad.z) && is_number(pad.z_dot) && is_number(pad.N) && is_number(pad.slip_speed);
}

bool is_bounded(const std::vector<ContactResult<double>>& contacts)
{
  return std::all_of(contacts.begin(), contacts.end(), [](const ContactResult<double>& pair) {
    return is_bounded(pair.upper) && is_bounded(pair.lower);
  });
}

/// A run under way.
struct Recording {
  const RecordingPlan& plan;
  const TransientCase& run;
  Recorder recorder;
  SnapshotRecorder states;
  std::optional<Resampler> sound = {};
  std::int64_t n = 0;  ///< samples so far
};

/// Samples between two looks at the clock, and of the sound that go to its file together.
constexpr std::int64_t samples_together = 1024;

/// From the first sample, or from where the checkpoint is, to the last.
/// @return whether the motion stayed bounded
bool record(TransientSteps& steps, Recording& at, const Keeping& keeping)
{
  const auto exchange = [&](StateArchive& archive) {
    archive(at.n, steps, at.recorder, at.states);
    if (at.sound) archive(*at.sound, *keeping.sound);
  };
  const auto hand_over_sound = [&] {
    if (at.sound) keeping.sound->add(at.sound->take());
  };
  const auto keep = [&] {
    hand_over_sound();
    keeping.checkpoint->keep(exchange);
  };
  if (keeping.checkpoint) keeping.checkpoint->give_back(exchange);
  while (at.n < at.plan.n_steps) {
    const double t = (double(at.n) + 0.5) * at.plan.step;
    const auto& contacts = steps.next();
    if (!is_bounded(contacts)) return false;
    at.recorder.add({at.n, t, turn_at(at.run, t).speed, contacts});
    at.states.add(at.n, t, steps);
    if (at.sound) at.sound->add(contacts.front().upper.z_dot);
    if (keeping.progress && at.n % at.plan.window == 0)
      keeping.progress(double(at.n) / double(at.plan.n_steps));
    if (++at.n % samples_together != 0) continue;
    hand_over_sound();
    if (keeping.checkpoint && keeping.checkpoint->is_due()) keep();
  }
  if (keeping.checkpoint && keeping.checkpoint->was_written()) keep();
  return true;
}

}  // namespace

Transient transient(const Disc& disc, const SquealOptions& options, const TransientCase& run,
                    const Keeping& keeping)
{
  if (options.pads.empty()) throw Error("transient: no pads");
  check_transient(run, disc.omega.maxCoeff());
  check_speed_program(options, run);
  const std::optional<InertialDisc> inertial = find_inertial_disc(disc);
  const IntegratorChoice choice = choose_integrator(disc, inertial, options, run);
  const RecordingPlan plan =
      recording_plan(run, frequencies_of(disc, options, run.speed), sampling_of(choice));
  const auto steps =
      transient_steps(disc, options, run, choice, plan.step,
                      transient_start(disc, inertial, run, options.pads.front().angle));
  Recording recording{.plan = plan,
                      .run = run,
                      .recorder = {plan, 0.5 * options.thickness},
                      .states = {disc, inertial, plan, run}};
  if (options.study.sound && keeping.sound)
    recording.sound.emplace(plan.step, options.study.sound->rate_Hz);
  const bool bounded = record(*steps, recording, keeping);
  Recorder& recorder = recording.recorder;
  recorder.finish();
  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = bounded;
  result.integrator = name_of(choice.kind);
  result.integrator_reason = choice.reason;
  result.n_steps = steps->n_steps();
  result.n_contact_evaluations = steps->n_contact_evaluations();
  result.n_events = steps->n_events();
  result.events = steps->events();
  if (run.speed_program.empty())
    result.growth_rate = growth_rate(result.envelope, linear_part * rest_compression(options));
  else
    result.speed = turn_at(run, run.duration).speed;
  result.snapshots = recording.states.snapshots();
  result.tail_a = recording.states.tail_a();
  result.warning = warning_of(result, disc, options);
  if (recording.sound) {
    recording.sound->finish();
    keeping.sound->add(recording.sound->take());
    keeping.sound->finish();
  }
  return result;
}

Growth growth(const Disc& disc, const SquealOptions& options, double speed, double duration)
{
  const Transient run =
      transient(disc, options, growth_case(speed, duration, rest_compression(options)));
  Growth result{speed, run.envelope, required_growth_rate(run, duration, disc.omega.minCoeff()),
                std::nullopt};
  if (const auto inertial = find_inertial_disc(disc))
    result.eigenvalue_rate = least_stable_eigenvalue(*inertial, options, speed).real();
  return result;
}

std::string divergence_of(const Transient& run)
{
  const double t = run.history.t.empty() ? 0.0 : run.history.t.back();
  return fmt::format(
      "the motion diverged after {:.3g} s; damping or the contact law do not bound it", t);
}

}  // namespace chladni::squeal
