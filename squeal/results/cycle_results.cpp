#include "squeal/results/cycle_results.hpp"

#include <cmath>
#include <complex>

namespace chladni::squeal {
namespace {

/// Of the multipliers in files of versions that did not estimate it.
constexpr double error_of_earlier_versions = 1e-6;

CycleStability stability_by(double largest_multiplier, const std::optional<double>& error)
{
  if (!(std::abs(largest_multiplier - 1.0) > error.value_or(error_of_earlier_versions)))
    return CycleStability::undecided;
  return largest_multiplier < 1.0 ? CycleStability::stable : CycleStability::unstable;
}

}  // namespace

const char* name_of(CycleStability stability)
{
  switch (stability) {
    case CycleStability::stable:
      return "stable";
    case CycleStability::unstable:
      return "unstable";
    default:
      return "undecided";
  }
}

CycleStability stability_of(const DirectLimitCycle& cycle)
{
  if (cycle.multipliers.size() < 2) return CycleStability::undecided;
  return stability_by(std::abs(cycle.multipliers[1]), cycle.multiplier_error);
}

CycleStability stability_of(const BranchPoint& point)
{
  return stability_by(point.largest_multiplier, point.multiplier_error);
}

}  // namespace chladni::squeal
