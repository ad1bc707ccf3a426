#include "squeal/transient/model_transient.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "common/error.hpp"
#include "squeal/motion/dop853.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/transient/growth_rate.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/transient_plan.hpp"

namespace chladni::squeal {
namespace {

/// Of order 8, so that growth rates are right to about 1e-9 of the frequency.
constexpr int steps_per_period = 40;

FrequencyRange frequencies_of(const Model& model, double speed)
{
  const Eigen::VectorXcd lambda = model.state_matrix(speed).eigenvalues();
  const double highest = lambda.cwiseAbs().maxCoeff();
  double lowest = highest;
  for (const std::complex<double>& value : lambda)
    if (value.imag() > 0.0) lowest = std::min(lowest, value.imag());
  return {.lowest = lowest, .highest = highest};
}

/// A run under way.
struct Recording {
  const RecordingPlan& plan;
  Eigen::VectorXd x;
  Recorder recorder;
  std::int64_t n = 0;  ///< samples so far
};

/// Samples between two looks at the clock.
constexpr std::int64_t samples_together = 1024;

/// From the first sample, or from where the checkpoint is, to the last.
/// @return whether the motion stayed bounded
bool record(const Model& model, const TransientCase& run, Recording& at, const Keeping& keeping)
{
  const auto exchange = [&](StateArchive& archive) { archive(at.n, at.x, at.recorder); };
  const auto f = [&](const Eigen::VectorXd& x) { return model.rate(x, run.speed); };
  if (keeping.checkpoint) keeping.checkpoint->give_back(exchange);
  while (at.n < at.plan.n_steps) {
    const std::vector<ContactResult<double>> contacts{model.contact(at.x, run.speed)};
    at.recorder.add({at.n, double(at.n) * at.plan.step, run.speed, contacts});
    at.x = dop853_step(f, at.x, at.plan.step);
    if (!(at.x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < motion_max)) return false;
    if (keeping.progress && at.n % at.plan.window == 0)
      keeping.progress(double(at.n) / double(at.plan.n_steps));
    if (++at.n % samples_together == 0 && keeping.checkpoint && keeping.checkpoint->is_due())
      keeping.checkpoint->keep(exchange);
  }
  if (keeping.checkpoint && keeping.checkpoint->was_written()) keeping.checkpoint->keep(exchange);
  return true;
}

}  // namespace

Transient transient(const Model& model, const TransientCase& run, const Keeping& keeping)
{
  if (run.integrator != IntegratorKind::automatic &&
      run.integrator != IntegratorKind::dormand_prince)
    throw Error(
        "transient: a model without a body has the integrator \"dormand-prince\" alone; leave "
        "integrator out");
  const RecordingPlan plan = recording_plan(run, frequencies_of(model, run.speed),
                                            run.steps_per_period.value_or(steps_per_period));
  Recording recording{.plan = plan,
                      .x = model.start(run.initial_pad_displacement),
                      .recorder = {plan, model.rest_height}};
  const bool bounded = record(model, run, recording, keeping);
  Recorder& recorder = recording.recorder;
  recorder.finish();
  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = bounded;
  result.integrator = "dormand-prince";
  result.integrator_reason = "of order 8 with fixed steps, for models without a body";
  result.growth_rate = growth_rate(result.envelope, linear_part * model.rest_compression);
  if (result.growth_rate)
    result.warning = warning_of_growth(
        *result.growth_rate, least_stable_eigenvalue(model.state_matrix(run.speed)).real());
  return result;
}

Growth growth(const Model& model, double speed, double duration)
{
  const Transient run = transient(model, growth_case(speed, duration, model.rest_compression));
  return {.speed = speed,
          .envelope = run.envelope,
          .rate = required_growth_rate(run, duration, frequencies_of(model, speed).lowest),
          .eigenvalue_rate = least_stable_eigenvalue(model.state_matrix(speed)).real()};
}

}  // namespace chladni::squeal
