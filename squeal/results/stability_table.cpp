#include "squeal/results/stability_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace chladni::squeal {

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

std::string summary(const StabilityTable& table)
{
  const auto n = std::ranges::count_if(table.branches, &StabilityBranch::is_unstable);
  if (n == 0)
    return fmt::format("no mode is unstable at any {} of the range",
                       table.parameter == "speed" ? "speed" : table.parameter + " value");
  return fmt::format("{} of {} modes {} unstable somewhere", n, table.branches.size(),
                     n == 1 ? "is" : "are");
}

}  // namespace chladni::squeal
