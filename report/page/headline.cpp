#include "report/page/headline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "report/describe_cycles.hpp"

namespace chladni::report {

std::string where_it_squeals(const squeal::SquealResults& results)
{
  const squeal::CriticalSpeed& critical = *results.critical_speed;
  std::string end = "rad/s";
  std::string others;
  if (results.speed_stability) {
    const squeal::StabilityProfile& profile = *results.speed_stability;
    const auto begins_there = [&](const squeal::UnstableInterval& interval) {
      return interval.from.value == critical.speed;
    };
    const auto interval = std::ranges::find_if(profile.unstable, begins_there);
    if (interval != profile.unstable.end() && interval->to.value < profile.to.value)
      end = fmt::format("to {:.4g} rad/s", interval->to.value);
    if (profile.unstable.size() > 1)
      others = fmt::format(", and in {} other range(s) of speeds", profile.unstable.size() - 1);
  }
  return fmt::format("squeals from {:.4g} {}, at {:.4g} Hz{}", critical.speed, end,
                     critical.frequency_Hz, others);
}

std::string name_of(const squeal::LimitCycle& cycle)
{
  if (!cycle.settled)
    return fmt::format("End of the transient at {:.5g} rad/s, not settled", cycle.speed);
  return fmt::format("Limit cycle at {:.5g} rad/s", cycle.speed);
}

std::string name_of(const squeal::DirectLimitCycle& cycle)
{
  const std::string doubt = doubt_of_stability(squeal::stability_of(cycle));
  return fmt::format("Limit cycle at {:.5g} rad/s{}{}", cycle.speed, doubt.empty() ? "" : ", ",
                     doubt);
}

}  // namespace chladni::report
