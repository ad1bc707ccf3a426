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

}  // namespace chladni::squeal
