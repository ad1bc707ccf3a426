#include "squeal/results/squeal_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "squeal/parameter_options.hpp"

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

double damping_ratio(const StabilityPoint& point)
{
  const double modulus = std::hypot(point.growth, 2.0 * std::numbers::pi * point.frequency_Hz);
  return modulus > 0.0 ? -point.growth / modulus : 0.0;
}

bool is_always_unstable(const StabilityTable& table, const StabilityBranch& branch)
{
  return branch.unstable.size() == 1 && branch.unstable.front().from.value == table.values[0] &&
         branch.unstable.front().to.value == table.values[table.values.size() - 1];
}

std::optional<int> nodal_diameters(const StabilityTable& table, const StabilityBranch& branch)
{
  std::map<int, double> shares;
  for (Eigen::Index i = 0; i < branch.shares.size(); ++i)
    shares[table.families[static_cast<std::size_t>(i)].nodal_diameters] += branch.shares[i];
  if (shares.empty()) return std::nullopt;
  return std::ranges::max_element(shares, {}, [](const auto& share) { return share.second; })
      ->first;
}

std::optional<int> nodal_circles(const StabilityTable& table, const StabilityBranch& branch)
{
  const std::optional<int> diameters = nodal_diameters(table, branch);
  std::optional<std::size_t> largest;
  for (std::size_t i = 0; i < table.families.size(); ++i) {
    if (table.families[i].nodal_diameters == diameters &&
        (!largest || branch.shares[static_cast<Eigen::Index>(i)] >
                         branch.shares[static_cast<Eigen::Index>(*largest)]))
      largest = i;
  }
  return largest ? table.families[*largest].nodal_circles : std::nullopt;
}

std::optional<double> in_plane_share(const StabilityTable& table, const StabilityBranch& branch)
{
  if (branch.shares.size() == 0) return std::nullopt;
  double sum = 0.0;
  for (std::size_t i = 0; i < table.families.size(); ++i) {
    if (!table.families[i].in_plane) return std::nullopt;
    sum += branch.shares[static_cast<Eigen::Index>(i)] * *table.families[i].in_plane;
  }
  return sum / branch.shares.sum();
}

std::string summary(const StabilityTable& table)
{
  const auto n = std::ranges::count_if(table.branches, &StabilityBranch::is_unstable);
  if (n == 0) {
    return fmt::format("no mode is unstable at any {} of the range",
                       table.parameter == "speed" ? "speed" : table.parameter + " value");
  }
  return fmt::format("{} of {} modes {} unstable somewhere", n, table.branches.size(),
                     n == 1 ? "is" : "are");
}

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

std::string spoken(const Band& band)
{
  switch (band.sampling) {
    case Sampling::whole:
      return fmt::format("every sample, {:.6g} in a second", band.rate_Hz);
    case Sampling::band_limited:
      return fmt::format("band-limited to {:.4g} Hz, {:.6g} samples in a second", band.to_Hz,
                         band.rate_Hz);
    case Sampling::decimated:
      break;
  }
  return "decimated: frequencies above half its rate look like lower ones";
}

std::string unit_of(const std::string& parameter)
{
  if (parameter == "speed") return "rad/s";
  const auto known = parameter_of(parameter);
  return known ? std::string(find_parameter(known->name)->unit) : "1";
}

}  // namespace chladni::squeal
