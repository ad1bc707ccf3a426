#include "squeal/study/run.hpp"

#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/parallel.hpp"
#include "squeal/stability/hopf.hpp"
#include "squeal/stability/mode_sensitivity.hpp"
#include "squeal/stability/mode_shapes.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/study/study_steps.hpp"
#include "squeal/study/validate.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {
namespace {

std::vector<Growth> growth_over_speeds(const Disc& disc, const SquealOptions& options)
{
  const GrowthCase& runs = *options.study.growth;
  std::vector<Growth> results(runs.speeds.size());
  for_each_index(static_cast<int>(runs.speeds.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    results[at] = growth(disc, options, runs.speeds[at], runs.duration);
  });
  return results;
}

EigenvalueMap eigenvalues_with_shapes(const Disc& disc, const SquealOptions& options)
{
  const InertialDisc inertial = inertial_disc(disc);
  EigenvalueMap map = eigenvalues(inertial, options);
  map.shapes = mode_shapes(inertial, options, map);
  map.mode_numbers = disc.mode_numbers;
  return map;
}

std::vector<CriticalValue> critical_values(const Disc& disc, const SquealOptions& options)
{
  const InertialDisc inertial = inertial_disc(disc);
  std::vector<CriticalValue> values;
  for (const CriticalCase& search : options.study.critical)
    values.push_back(critical_value(inertial, options, search));
  return values;
}

/// In the order in which they are done.
std::vector<StudyStep> steps_of(const Disc& disc, const SquealOptions& options)
{
  return {
      {{"eigenvalues"},
       [&](auto& r, auto&) { r.eigenvalues = eigenvalues_with_shapes(disc, options); }},
      {{"critical-speed"},
       [&](auto& r, auto&) {
         r.speed_stability = stability_over_speed(inertial_disc(disc), options);
         r.critical_speed = critical_speed(*r.speed_stability);
         r.searched_critical_speed = true;
       }},
      {{"critical-values"},
       [&](auto& r, auto&) { r.critical_values = critical_values(disc, options); }},
      {{"stability-map"},
       [&](auto& r, auto&) { r.map = stability_map(inertial_disc(disc), options); }},
      {{"mode-sensitivity"},
       [&](auto& r, auto&) {
         r.mode_sensitivity = mode_sensitivity(inertial_disc(disc), options);
       }},
      {{"rotation-stability"},
       [&](auto& r, auto&) { r.rotation_stability = rotation_stability(disc, options); }},
      {{"growth"}, [&](auto& r, auto&) { r.growth = growth_over_speeds(disc, options); }},
      {{"transient", "limit-cycle", "spectrum"},
       [&](auto& r, auto& keeping) {
         r.transient = transient(disc, options, *options.study.transient, keeping);
       }},
      {{"spectrum"},
       [&](auto& r, auto&) {
         r.spectrum = spectrum(r.transient->tail.pad_velocity, r.transient->step);
       }},
      {{"limit-cycle"}, [&](auto& r, auto&) { r.limit_cycle = limit_cycle(disc, *r.transient); }},
      {{"limit-cycle-direct"},
       [&](auto& r, auto&) {
         r.limit_cycle_direct =
             limit_cycle_direct(disc, options, options.study.limit_cycle_direct->speed);
       }},
      {{"limit-cycle-branch"}, [&](auto& r, auto& keeping) {
         r.limit_cycle_branch = limit_cycle_branch(disc, options, keeping.progress);
       }}};
}

}  // namespace

SquealResults run(const Disc& disc, const SquealOptions& options, const StudyKeeping& keeping)
{
  validate(options);
  SquealResults results;
  results.wheel_radius = options.study.speeds.wheel_radius;
  if (const auto inertial = find_inertial_disc(disc))
    results.largest_split = inertial->largest_split;
  return perform_steps(steps_of(disc, options), options.study.analyses, std::move(results),
                       keeping);
}

}  // namespace chladni::squeal
