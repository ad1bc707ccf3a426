#include "squeal/study/analysis_steps.hpp"

#include <mutex>
#include <utility>

#include "squeal/cycle/cycle_errors.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/parallel.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/stability/gradients.hpp"
#include "squeal/stability/hopf.hpp"
#include "squeal/stability/mode_sensitivity.hpp"
#include "squeal/stability/mode_shapes.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/unstable_modes.hpp"
#include "squeal/transient/motion_statistics.hpp"
#include "squeal/transient/spectrogram.hpp"
#include "squeal/transient/spectrum.hpp"

namespace chladni::squeal {
namespace {

void find_eigenvalues(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  EigenvalueMap map = eigenvalues(state_matrix_at(study.brake), study.options.speeds);
  if (const FlexibleDisc* body = study.brake.body()) {
    map.shapes = mode_shapes(body->inertial(), body->options(), map);
    map.mode_numbers = body->disc().mode_numbers;
  }
  results.eigenvalues = std::move(map);
}

/// Of a disc that is not axisymmetric by Hill's method.
StabilityProfile speed_stability(const Study& study)
{
  const SpeedRange& speeds = study.options.speeds;
  if (study.brake.is_autonomous())
    return stability_over_speed(state_matrix_at(study.brake), speeds);
  return profile_of(study.turning.table(
      *study.brake.body(),
      {.over = {}, .from = speeds.from, .to = speeds.to, .count = speeds.count, .band = {}}));
}

void find_critical_speed(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  results.speed_stability = speed_stability(study);
  results.critical_speed = critical_speed(*results.speed_stability);
  const FlexibleDisc* body = study.brake.body();
  if (results.critical_speed && body && body->is_autonomous())
    results.critical_speed->budget = error_budget(*body, *results.critical_speed);
  results.searched_critical_speed = true;
}

void find_unstable_modes(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const auto by_hill = [&](const FlexibleDisc& body, const StabilityCase& search) {
    return study.turning.table(body, search);
  };
  results.stability_table = unstable_modes(study.brake, stability_case(study.options), by_hill);
}

void find_critical_values(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  std::vector<CriticalValue> values;
  for (const CriticalCase& search : study.options.critical)
    values.push_back(critical_value(study.brake, search));
  results.critical_values = std::move(values);
}

void find_map(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  results.map = stability_map(study.brake, study.options.map.value(), study.options.speeds);
}

void find_mode_sensitivity(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc& body = *study.brake.body();
  results.mode_sensitivity = mode_sensitivity(body.inertial(), body.options());
}

void find_gradients(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  results.gradients = gradients(study.brake, study.options);
}

void find_rotation_stability(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc& body = *study.brake.body();
  results.rotation_stability = rotation_stability(body.disc(), body.options());
}

void find_growth(const Study& study, SquealResults& results, const Keeping& keeping)
{
  const GrowthCase& runs = study.options.growth.value();
  std::vector<Growth> found(runs.speeds.size());
  std::mutex telling;
  std::size_t n_done = 0;
  for_each_index(static_cast<int>(found.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    found[at] = growth(study.brake, runs.speeds[at], runs.duration);
    const std::lock_guard lock(telling);
    keeping.progress(double(++n_done) / double(found.size()));
  });
  results.growth = std::move(found);
}

void find_transient(const Study& study, SquealResults& results, const Keeping& keeping)
{
  results.transient = transient(study.brake, study.options.transient.value(), keeping);
}

void find_spectrum(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.spectrum = spectrum(results.transient->tail.pad_velocity, results.transient->step);
}

void find_spectrogram(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.spectrogram = spectrogram(*results.transient);
}

void find_motion_statistics(const Study& /*study*/, SquealResults& results,
                            const Keeping& /*keeping*/)
{
  results.motion_statistics = motion_statistics(*results.transient);
}

void find_limit_cycle(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.limit_cycle = limit_cycle(*results.transient);
}

void find_limit_cycle_direct(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  DirectLimitCycle cycle =
      limit_cycle_direct(study.brake, study.options.limit_cycle_direct.value().speed);
  cycle.errors = cycle_errors(study.brake, cycle);
  results.limit_cycle_direct = std::move(cycle);
}

void find_limit_cycle_branch(const Study& study, SquealResults& results, const Keeping& keeping)
{
  results.limit_cycle_branch =
      limit_cycle_branch(study.brake, study.options.speeds, keeping.progress);
}

}  // namespace

std::span<const AnalysisStep> analysis_steps()
{
  static const AnalysisStep steps[] = {
      {"eigenvalues", 1.0, {}, find_eigenvalues},
      {"critical-speed", 1.0, {}, find_critical_speed},
      {"stability", 5.0, {}, find_unstable_modes},
      {"critical-values", 2.0, {}, find_critical_values},
      {"stability-map", 10.0, {}, find_map},
      {"mode-sensitivity", 10.0, {}, find_mode_sensitivity},
      {"gradients", 3.0, {}, find_gradients},
      {"rotation-stability", 20.0, {}, find_rotation_stability},
      {"growth", 40.0, {}, find_growth},
      {"transient",
       60.0,
       {"limit-cycle", "motion-statistics", "spectrum", "spectrogram"},
       find_transient},
      {"spectrum", 1.0, {}, find_spectrum},
      {"spectrogram", 1.0, {}, find_spectrogram},
      {"motion-statistics", 1.0, {}, find_motion_statistics},
      {"limit-cycle", 1.0, {}, find_limit_cycle},
      {"limit-cycle-direct", 10.0, {}, find_limit_cycle_direct},
      {"limit-cycle-branch", 40.0, {}, find_limit_cycle_branch},
  };
  return steps;
}

}  // namespace chladni::squeal
