#include "squeal/run.hpp"

#include <algorithm>

#include "squeal/inertial_frame.hpp"
#include "squeal/limit_cycle.hpp"
#include "squeal/limit_cycle_branch.hpp"
#include "squeal/limit_cycle_direct.hpp"
#include "squeal/mode_sensitivity.hpp"
#include "squeal/stability.hpp"
#include "squeal/stability_map.hpp"
#include "squeal/transient.hpp"
#include "squeal/validate.hpp"

namespace chladni::squeal {
namespace {

std::vector<Growth> growth_over_speeds(const Disc& disc, const SquealOptions& options,
                                       const Progress& progress)
{
  const GrowthCase& runs = *options.growth;
  std::vector<Growth> results;
  for (const double speed : runs.speeds) {
    progress(double(results.size()) / double(runs.speeds.size()));
    results.push_back(growth(disc, options, speed, runs.duration));
  }
  return results;
}

}  // namespace

SquealResults run(const Disc& disc, const SquealOptions& options, const RunProgress& progress)
{
  validate(options);
  const auto asked = [&](const char* analysis) {
    return std::find(options.analyses.begin(), options.analyses.end(), analysis) !=
           options.analyses.end();
  };
  const auto progress_of = [&](const std::string& analysis) -> Progress {
    return [&progress, analysis](double fraction) {
      if (progress) progress(analysis, fraction);
    };
  };
  SquealResults results;
  if (const auto inertial = find_inertial_disc(disc))
    results.largest_split = inertial->largest_split;
  if (asked("eigenvalues")) {
    progress_of("eigenvalues")(0.0);
    results.eigenvalues = eigenvalues(inertial_disc(disc), options);
  }
  if (asked("critical-speed")) {
    progress_of("critical-speed")(0.0);
    results.critical_speed = critical_speed(inertial_disc(disc), options);
    results.searched_critical_speed = true;
  }
  if (asked("stability-map")) {
    progress_of("stability-map")(0.0);
    results.map = stability_map(inertial_disc(disc), options);
  }
  if (asked("mode-sensitivity")) {
    progress_of("mode-sensitivity")(0.0);
    results.mode_sensitivity = mode_sensitivity(inertial_disc(disc), options);
  }
  if (asked("growth")) results.growth = growth_over_speeds(disc, options, progress_of("growth"));
  if (asked("transient") || asked("limit-cycle"))
    results.transient = transient(disc, options, *options.transient, progress_of("transient"));
  if (asked("limit-cycle")) results.limit_cycle = limit_cycle(disc, *results.transient);
  if (asked("limit-cycle-direct")) {
    progress_of("limit-cycle-direct")(0.0);
    results.limit_cycle_direct =
        limit_cycle_direct(disc, options, options.limit_cycle_direct->speed);
  }
  if (asked("limit-cycle-branch"))
    results.limit_cycle_branch =
        limit_cycle_branch(disc, options, progress_of("limit-cycle-branch"));
  return results;
}

}  // namespace chladni::squeal
