#include "squeal/model_transient.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "common/error.hpp"
#include "squeal/dop853.hpp"
#include "squeal/growth_rate.hpp"
#include "squeal/recorder.hpp"
#include "squeal/stability.hpp"
#include "squeal/transient_plan.hpp"

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

}  // namespace

Transient transient(const Model& model, const TransientCase& run, const Progress& progress)
{
  if (run.integrator != IntegratorKind::automatic &&
      run.integrator != IntegratorKind::dormand_prince)
    throw Error(
        "transient: a model without a body has the integrator \"dormand-prince\" alone; leave "
        "integrator out");
  const RecordingPlan plan = recording_plan(run, frequencies_of(model, run.speed),
                                            run.steps_per_period.value_or(steps_per_period));
  Recorder recorder(plan, model.rest_height);
  const auto f = [&](const Eigen::VectorXd& x) { return model.rate(x, run.speed); };
  Eigen::VectorXd x = model.start(run.initial_pad_displacement);
  bool finite = true;
  for (std::int64_t i = 0; i < plan.n_steps && finite; ++i) {
    recorder.add(i, double(i) * plan.step, {model.contact(x, run.speed)});
    x = dop853_step(f, x, plan.step);
    finite = x.allFinite();
    if (progress && i % plan.window == 0) progress(double(i) / double(plan.n_steps));
  }
  Transient result = recorder.transient();
  result.speed = run.speed;
  result.finished = finite;
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
