#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

std::optional<StabilityPoint> first_loss(const StabilityProfile& profile)
{
  for (const UnstableInterval& interval : profile.unstable)
    if (interval.from.value > profile.from.value) return interval.from;
  return std::nullopt;
}

std::optional<StabilityPoint> first_regain(const StabilityProfile& profile)
{
  for (const UnstableInterval& interval : profile.unstable)
    if (interval.to.value < profile.to.value) return interval.to;
  return std::nullopt;
}

Stability stability_of(const StabilityProfile& profile)
{
  if (profile.unstable.empty()) return Stability::stable;
  if (first_loss(profile)) return Stability::lost;
  return first_regain(profile) ? Stability::regained : Stability::unstable;
}

const char* name_of(Stability stability)
{
  switch (stability) {
    case Stability::stable:
      return "stable in the whole range";
    case Stability::unstable:
      return "unstable in the whole range";
    case Stability::lost:
      return "lost within the range";
    case Stability::regained:
      return "regained within the range";
  }
  return "";
}

}  // namespace chladni::squeal
