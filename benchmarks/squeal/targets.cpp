#include "benchmarks/squeal/targets.hpp"

#include <fmt/format.h>

#include <cmath>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/transient/integrator_choice.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal::bench {
namespace {

using namespace test;

std::vector<Target> transient_targets(bool smallest)
{
  const Disc pair = disc_of({kirchhoff_3(1672.13)}), all = disc_of(kirchhoff_modes());
  const double seconds = smallest ? 0.5 : 6.0, speed = 6.0 * pi;
  Transient run{};
  const double time = seconds_of([&] {
    run = transient(FlexibleDisc(pair, reference_options()),
                    {.speed = speed, .duration = seconds, .initial_pad_displacement = 6.8e-8});
  });
  const double rate =
      least_stable_eigenvalue(state_matrix(inertial_disc(pair), reference_options(), speed)).real();
  const double large = smallest ? 0.02 : 1.0;
  const double time_all = seconds_of([&] {
    transient(FlexibleDisc(all, reference_options(ContactLaw::unilateral)),
              {.speed = speed, .duration = large, .initial_pad_displacement = 1e-4});
  });
  return {
      {"6 s transient of two modes, time over real time", "1", time / seconds, 0.1},
      {"its error of the growth rate", "1/s", std::abs(run.growth_rate.value_or(NAN) - rate), 1e-3},
      {"transient of 35 modes below 16 kHz, time over real time", "1", time_all / large, 1.0}};
}

std::vector<Target> map_targets(bool smallest)
{
  const Disc pair = disc_of({kirchhoff_3(1672.13)}), all = disc_of(kirchhoff_modes());
  SquealOptions options = reference_options();
  const int n = smallest ? 10 : 100;
  options.study.speeds.count = n;
  options.study.map =
      MapCase{.parameter = MapParameter::friction, .from = 0.1, .to = 1.0, .count = n};
  const double map = seconds_of([&] {
    stability_map(FlexibleDisc(pair, options), *options.study.map, options.study.speeds);
  });
  std::vector<Target> targets{
      {fmt::format("stability map of {0} x {0} points, two modes", n), "s", map, 10.0}};
  if (!smallest)
    targets.push_back({"stability map of 100 x 100 points, 35 modes", "s", seconds_of([&] {
                         stability_map(FlexibleDisc(all, options), *options.study.map,
                                       options.study.speeds);
                       }),
                       2.0});
  return targets;
}

/// Contact evaluations of the transient of 6 s, by each integrator at its default settings, over
/// those of the direct limit cycle.
std::vector<Target> direct_targets(ContactLaw law, bool smallest)
{
  const Disc pair = disc_of({kirchhoff_3(1672.13)});
  const std::string name = law == ContactLaw::bilateral    ? "bilateral"
                           : law == ContactLaw::unilateral ? "unilateral"
                                                           : "signed";
  const double seconds = smallest ? 0.2 : 6.0;
  const DirectLimitCycle cycle =
      limit_cycle_direct(FlexibleDisc(pair, reference_options(law)), 6.0 * pi);
  const auto direct = double(cycle.n_contact_evaluations);
  std::vector<Target> targets{
      {fmt::format("contact evaluations of the direct limit cycle, {}", name), "1", direct, 0.0}};
  for (const IntegratorKind kind :
       {IntegratorKind::exponential, IntegratorKind::splitting, IntegratorKind::dormand_prince,
        IntegratorKind::generalised_alpha}) {
    const Transient run =
        transient(FlexibleDisc(pair, reference_options(law)), {.speed = 6.0 * pi,
                                                               .duration = seconds,
                                                               .initial_pad_displacement = 6.8e-8,
                                                               .integrator = kind});
    targets.push_back(
        {fmt::format("those of the transient of 6 s by {} over them, {}", name_of(kind), name), "1",
         double(run.n_contact_evaluations) * 6.0 / seconds / direct, 50.0});
  }
  return targets;
}

}  // namespace

std::vector<Target> measured_targets(bool smallest)
{
  std::vector<Target> targets = transient_targets(smallest);
  const auto add = [&](const std::vector<Target>& more) {
    targets.insert(targets.end(), more.begin(), more.end());
  };
  add(map_targets(smallest));
  for (const ContactLaw law :
       {ContactLaw::bilateral, ContactLaw::unilateral, ContactLaw::signed_force})
    add(direct_targets(law, smallest));
  return targets;
}

std::string json_of(const std::vector<Target>& targets)
{
  std::string text = "[";
  for (const Target& target : targets) {
    text += fmt::format(
        "{}\n  {{\"name\": \"{}\", \"unit\": \"{}\", \"measured\": {:.4g}, \"target\": {:g}}}",
        text.size() > 1 ? "," : "", target.name, target.unit, target.measured, target.limit);
  }
  return text + "]";
}

}  // namespace chladni::squeal::bench
