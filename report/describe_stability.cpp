#include "report/describe_squeal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <vector>

#include "report/json.hpp"
#include "report/text_table.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::report {

using Eigen::Index;
using squeal::StabilityBranch, squeal::StabilityTable;

namespace {

/// Families of modes and pads that are told of, and the least share that is.
constexpr std::size_t most_shares = 3;
constexpr double least_share = 0.05;

/// "unstable at all speeds" or "unstable from 13.4 to 62.8 rad/s".
std::string where(const StabilityTable& table, const StabilityBranch& branch)
{
  if (is_always_unstable(table, branch)) {
    return "unstable at all " +
           (table.parameter == "speed" ? "speeds" : table.parameter + " values");
  }
  const std::string unit = squeal::unit_of(table.parameter);
  std::vector<std::string> intervals;
  for (const squeal::UnstableInterval& interval : branch.unstable)
    intervals.push_back(fmt::format("{:.6g} to {:.6g}", interval.from.value, interval.to.value));
  return fmt::format("unstable from {}{}", fmt::join(intervals, ", "),
                     unit == "1" ? "" : " " + unit);
}

/// "; 3 nodal diameters: 92 % (3, 1750 Hz), 6 % pads"; empty without a body.
std::string participation(const StabilityTable& table, const StabilityBranch& branch)
{
  const std::optional<int> diameters = nodal_diameters(table, branch);
  if (!diameters) return "";
  std::vector<std::size_t> order(table.families.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto share = [&](std::size_t i) { return branch.shares[static_cast<Eigen::Index>(i)]; };
  std::ranges::stable_sort(order, std::ranges::greater(), share);
  std::vector<std::string> parts;
  for (const std::size_t i : order) {
    if (parts.size() == most_shares || share(i) < least_share) break;
    const squeal::ModeFamily& family = table.families[i];
    parts.push_back(fmt::format("{:.0f} % ({}, {:.0f} Hz)", 100.0 * share(i),
                                family.nodal_diameters, family.frequency_Hz));
  }
  if (branch.pads >= least_share)
    parts.push_back(fmt::format("{:.0f} % pads", 100.0 * branch.pads));
  const std::optional<int> circles = nodal_circles(table, branch);
  const std::optional<double> in_plane = in_plane_share(table, branch);
  return fmt::format(
      "; {} nodal diameter{}{}{}: {}", *diameters, *diameters == 1 ? "" : "s",
      circles ? fmt::format(", {} circle{}", *circles, *circles == 1 ? "" : "s") : "",
      in_plane && *in_plane > least_share ? fmt::format(", {:.0f} % in plane", 100.0 * *in_plane)
                                          : "",
      fmt::join(parts, ", "));
}

/// "; friction feeds 12 % of its energy in a period"; empty without a body.
std::string feeding(const StabilityBranch& branch)
{
  if (!branch.work) return "";
  return fmt::format("; friction feeds {:.3g} % of its energy in a period",
                     100.0 * branch.work->friction);
}

Json stability_branch_json(const StabilityTable& table, const StabilityBranch& branch)
{
  std::vector<Json> unstable;
  for (const squeal::UnstableInterval& interval : branch.unstable)
    unstable.push_back(Json::array({interval.from.value, interval.to.value}));
  const std::optional<int> diameters = nodal_diameters(table, branch);
  const std::optional<int> circles = nodal_circles(table, branch);
  const std::optional<double> in_plane = in_plane_share(table, branch);
  return Json::object(
      {{"unstable", Json::array(unstable)},
       {"worst_value", branch.worst.value},
       {"worst_growth_1_s", branch.worst.growth},
       {"worst_frequency_Hz", branch.worst.frequency_Hz},
       {"worst_growth_errors_1_s", branch.budget.is_empty() ? Json() : budget_json(branch.budget)},
       {"damping_ratio", damping_ratio(branch.worst)},
       {"nodal_diameters", diameters ? Json(*diameters) : Json()},
       {"nodal_circles", circles ? Json(*circles) : Json()},
       {"in_plane", in_plane ? Json(*in_plane) : Json()},
       {"shares", numbers_json(branch.shares)},
       {"pads", table.is_by_hill() ? Json() : Json(branch.pads)},
       {"friction_work", branch.work ? Json(branch.work->friction) : Json()},
       {"normal_work", branch.work ? Json(branch.work->normal) : Json()},
       {"damping_work", branch.work ? Json(branch.work->damping) : Json()},
       {"growth_1_s", numbers_json(branch.lambda.real())},
       {"frequency_Hz", frequencies_json(branch.lambda.imag())}});
}

}  // namespace

void add_unstable_modes(TextTable& table, const StabilityTable& stability)
{
  table.rows.push_back({"stability of all modes", summary(stability), ""});
  if (stability.is_by_hill()) {
    table.rows.push_back({"method of the table", "Hill", ""});
    add(table, "estimated error of the table's growth rates", stability.error, "1/s");
  }
  bool lacks_part = false;
  for (const StabilityBranch& branch : stability.branches) {
    if (!branch.is_unstable()) continue;
    const std::string name =
        fmt::format("largest growth, at {:.2f} Hz; {}; damping ratio {:.3g}{}{}",
                    branch.worst.frequency_Hz, where(stability, branch),
                    damping_ratio(branch.worst), participation(stability, branch), feeding(branch));
    if (branch.budget.is_empty()) {
      add(table, name, branch.worst.growth, "1/s");
      continue;
    }
    table.rows.push_back({name, with_error(branch.worst.growth, branch.budget.sum()), "1/s"});
    lacks_part = lacks_part || !branch.budget.body;
  }
  if (lacks_part)
    table.rows.push_back({"not in these errors: modes that the body lacks", "unknown", ""});
}

std::string parts_of(const squeal::ErrorBudget& budget)
{
  std::vector<std::string> parts;
  const auto add_part = [&](const char* name, const std::optional<double>& part) {
    if (part) parts.push_back(fmt::format("{} {:.1g}", name, *part));
  };
  add_part("mesh", budget.mesh);
  add_part("reduction", budget.reduction);
  add_part("body", budget.body);
  add_part("modes left out", budget.left_out);
  add_part("integration", budget.integration);
  return fmt::format("{}", fmt::join(parts, ", "));
}

Json budget_json(const squeal::ErrorBudget& budget)
{
  return Json::object({{"mesh", optional_json(budget.mesh)},
                       {"reduction", optional_json(budget.reduction)},
                       {"body", optional_json(budget.body)},
                       {"modes_left_out", optional_json(budget.left_out)},
                       {"integration", optional_json(budget.integration)}});
}

Json stability_table_json(const StabilityTable& stability)
{
  std::vector<Json> families, branches;
  for (const squeal::ModeFamily& family : stability.families) {
    families.push_back(Json::object(
        {{"nodal_diameters", family.nodal_diameters},
         {"frequency_Hz", family.frequency_Hz},
         {"nodal_circles", family.nodal_circles ? Json(*family.nodal_circles) : Json()},
         {"in_plane", family.in_plane ? Json(*family.in_plane) : Json()}}));
  }
  for (const StabilityBranch& branch : stability.branches)
    branches.push_back(stability_branch_json(stability, branch));
  const auto& band = stability.band;
  return Json::object({{"parameter", stability.parameter},
                       {"method", stability.method.empty() ? "eigenvalues" : stability.method},
                       {"error_1_s", stability.is_by_hill() ? Json(stability.error) : Json()},
                       {"speed_rad_s", stability.speed ? Json(*stability.speed) : Json()},
                       {"band_Hz", band ? Json::array({band->from_Hz, band->to_Hz}) : Json()},
                       {"values", numbers_json(stability.values)},
                       {"summary", summary(stability)},
                       {"families", Json::array(families)},
                       {"branches", Json::array(branches)}});
}

namespace {

/// Those that grow at the speed of the largest growth, the worst first; that one at least.
void add_worst(TextTable& table, const squeal::RotationStability& stability)
{
  Index at = 0;
  stability.growth.maxCoeff(&at);
  for (Index j = 0; j < stability.exponents.cols(); ++j) {
    const std::complex<double> lambda = stability.exponents(at, j);
    if (j > 0 && !(lambda.real() > 0.0)) return;
    add(table,
        fmt::format("growth at {:.6g} rad/s of {:.2f} Hz (rotation)", stability.speeds[at],
                    lambda.imag() / (2.0 * std::numbers::pi)),
        lambda.real(), "1/s");
  }
}

void add_frozen(TextTable& table, const squeal::RotationStability& stability)
{
  add(table, "the same from a disc that stands at its worst angle",
      stability.frozen_growth.maxCoeff(), "1/s");
  const Index misled =
      ((stability.frozen_growth.array() > 0.0) != (stability.growth.array() > 0.0)).count();
  if (misled > 0)
    add_count(table, "speeds at which the standing disc misleads about stability", misled);
}

}  // namespace

void add_rotation_method(TextTable& table, const squeal::RotationStability& stability)
{
  if (stability.method == "hill") {
    table.rows.push_back(
        {"method (rotation)",
         fmt::format("Hill, K = {} harmonics of the rotation", stability.harmonics), ""});
    add(table, "estimated error of its growth rates", stability.error, "1/s");
  } else if (!stability.method.empty()) {
    table.rows.push_back({"method (rotation)", "Floquet, integrated over one rotation", ""});
  }
  if (stability.exponents.size() > 0) add_worst(table, stability);
  if (stability.frozen_growth.size() > 0) add_frozen(table, stability);
}

}  // namespace chladni::report
