#include "squeal/model_run.hpp"

#include <algorithm>

#include "squeal/limit_cycle.hpp"
#include "squeal/model_transient.hpp"
#include "squeal/oscillator.hpp"
#include "squeal/rigid_model.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

Model build(const RigidDiscStudy& study)
{
  return model_of(study.disc, study.drive, study.equations);
}

Model build(const Oscillator& oscillator)
{
  return model_of(oscillator);
}

}  // namespace

SquealResults run(const ModelOptions& options, const RunProgress& progress)
{
  const Model model = std::visit([](const auto& study) { return build(study); }, options.model);
  const auto asked = [&](const char* analysis) {
    return std::find(options.analyses.begin(), options.analyses.end(), analysis) !=
           options.analyses.end();
  };
  const auto report = [&](const char* analysis, double fraction) {
    if (progress) progress(analysis, fraction);
  };
  SquealResults results;
  if (asked("eigenvalues")) results.eigenvalues = eigenvalues(model.state_matrix, options.speeds);
  if (asked("critical-speed")) {
    results.critical_speed = critical_speed(model.state_matrix, options.speeds);
    results.searched_critical_speed = true;
  }
  if (asked("growth"))
    for (const double speed : options.growth->speeds) {
      report("growth", double(results.growth.size()) / double(options.growth->speeds.size()));
      results.growth.push_back(growth(model, speed, options.growth->duration));
    }
  if (asked("transient") || asked("limit-cycle"))
    results.transient = transient(model, *options.transient,
                                  [&](double fraction) { report("transient", fraction); });
  if (asked("limit-cycle")) results.limit_cycle = limit_cycle(Disc{}, *results.transient);
  return results;
}

}  // namespace chladni::squeal
