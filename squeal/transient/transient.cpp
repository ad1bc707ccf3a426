#include "squeal/transient/transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/motion/speed_program.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/transient/growth_rate.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/prepared_transient.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/resampler.hpp"

namespace chladni::squeal {
namespace {

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
  std::int64_t n = 0;  ///< samples so far
};

/// Samples between two looks at the clock, and of the sound that go to its file together.
constexpr std::int64_t samples_together = 1024;

/// From the first sample, or from where the checkpoint is, to the last.
/// @return whether the motion stayed bounded
bool record(Recording& at, const Keeping& keeping)
{
  TransientSteps& steps = *at.ready.steps;
  const RecordingPlan& plan = at.ready.plan;
  const auto exchange = [&](StateArchive& archive) {
    archive(at.n, steps, at.recorder);
    if (at.ready.states) archive(*at.ready.states);
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
  while (at.n < plan.n_steps) {
    const double t = (double(at.n) + at.ready.first_sample) * plan.step;
    const auto& contacts = steps.next();
    if (!is_bounded(contacts)) return false;
    at.recorder.add({at.n, t, turn_at(at.run, t).speed, contacts});
    if (at.ready.states) at.ready.states->add(at.n, t, *at.ready.modal);
    if (at.sound) at.sound->add(contacts.front().upper.z_dot);
    if (keeping.progress && at.n % plan.window == 0)
      keeping.progress(double(at.n) / double(plan.n_steps));
    if (++at.n % samples_together != 0) continue;
    hand_over_sound();
    if (keeping.checkpoint && keeping.checkpoint->is_due()) keep();
  }
  if (keeping.checkpoint && keeping.checkpoint->was_written()) keep();
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
  if (ready.states) {
    result.snapshots = ready.states->snapshots();
    result.tail_a = ready.states->tail_a();
  }
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

}  // namespace chladni::squeal
