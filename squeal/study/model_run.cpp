#include "squeal/study/model_run.hpp"

#include <utility>

#include "common/error.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/oscillator.hpp"
#include "squeal/models/rigid_model.hpp"
#include "squeal/stability/hopf.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/study/study_steps.hpp"
#include "squeal/transient/model_transient.hpp"
#include "squeal/transient/transient.hpp"

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

RigidDiscStudy changed(RigidDiscStudy study, MapParameter parameter, double value)
{
  if (parameter == MapParameter::friction) study.disc.friction.kinetic = value;
  if (parameter == MapParameter::preload) study.disc.preload = value;
  if (parameter == MapParameter::stiffness) study.disc.spring.linear = value;
  return study;
}

Oscillator changed(Oscillator oscillator, MapParameter parameter, double value)
{
  if (parameter == MapParameter::friction) oscillator.friction.kinetic = value;
  if (parameter == MapParameter::preload) oscillator.preload = value;
  if (parameter == MapParameter::stiffness) oscillator.contact_stiffness = value;
  return oscillator;
}

Model model_with(const ModelOptions& options, MapParameter parameter, double value)
{
  return std::visit([&](const auto& study) { return build(changed(study, parameter, value)); },
                    options.model);
}

CycleProblem cycle_problem_of(const Model& model)
{
  if (!model.motion)
    throw Error(
        "limit cycle: the linearised equations of the rigid disc have none; take equations = "
        "\"nonlinear\"");
  return cycle_problem(model);
}

std::vector<CriticalValue> critical_values(const ModelOptions& options)
{
  std::vector<CriticalValue> values;
  for (const CriticalCase& search : options.study.critical)
    values.push_back(critical_value(
        [&](double value) {
          return model_with(options, search.parameter, value).state_matrix(search.speed);
        },
        search));
  return values;
}

StabilityMap map_of(const ModelOptions& options)
{
  const MapCase& range = options.study.map.value();
  return stability_map(
      [&](double value) { return model_with(options, range.parameter, value).state_matrix; }, range,
      options.study.speeds);
}

std::vector<Growth> growths(const Model& model, const GrowthCase& runs, const Progress& progress)
{
  std::vector<Growth> results;
  for (const double speed : runs.speeds) {
    progress(double(results.size()) / double(runs.speeds.size()));
    results.push_back(growth(model, speed, runs.duration));
  }
  return results;
}

/// In the order in which they are done.
std::vector<StudyStep> steps_of(const Model& model, const ModelOptions& options)
{
  return {
      {{"eigenvalues"},
       [&](auto& r, auto&) {
         r.eigenvalues = eigenvalues(model.state_matrix, options.study.speeds);
       }},
      {{"critical-speed"},
       [&](auto& r, auto&) {
         r.speed_stability = stability_over_speed(model.state_matrix, options.study.speeds);
         r.critical_speed = critical_speed(*r.speed_stability);
         r.searched_critical_speed = true;
       }},
      {{"critical-values"}, [&](auto& r, auto&) { r.critical_values = critical_values(options); }},
      {{"stability-map"}, [&](auto& r, auto&) { r.map = map_of(options); }},
      {{"growth"},
       [&](auto& r, auto& keeping) {
         r.growth = growths(model, *options.study.growth, keeping.progress);
       }},
      {{"transient", "limit-cycle"},
       [&](auto& r, auto& keeping) {
         r.transient = transient(model, *options.study.transient, keeping);
       }},
      {{"limit-cycle"}, [&](auto& r, auto&) { r.limit_cycle = limit_cycle(Disc{}, *r.transient); }},
      {{"limit-cycle-direct"},
       [&](auto& r, auto&) {
         r.limit_cycle_direct = limit_cycle_direct(cycle_problem_of(model),
                                                   options.study.limit_cycle_direct.value().speed);
       }},
      {{"limit-cycle-branch"}, [&](auto& r, auto& keeping) {
         r.limit_cycle_branch =
             limit_cycle_branch(cycle_problem_of(model), options.study.speeds, keeping.progress);
       }}};
}

}  // namespace

SquealResults run(const ModelOptions& options, const StudyKeeping& keeping)
{
  const Model model = std::visit([](const auto& study) { return build(study); }, options.model);
  SquealResults results;
  results.wheel_radius = options.study.speeds.wheel_radius;
  return perform_steps(steps_of(model, options), options.study.analyses, std::move(results),
                       keeping);
}

}  // namespace chladni::squeal
