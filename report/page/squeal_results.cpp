#include "report/page/squeal_results.hpp"

#include <algorithm>
#include <numbers>

#include "report/describe_cycles.hpp"
#include "report/describe_gradients.hpp"
#include "report/page/headline.hpp"
#include "report/page/motion_statistics.hpp"
#include "report/page/numbers.hpp"
#include "report/page/order_tracks.hpp"
#include "squeal/results/analysis_file.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/transient/growth_rate.hpp"

namespace chladni::report {
namespace {

using Eigen::Index;

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr std::size_t n_windows = 600;  ///< of a thinned history
constexpr std::size_t most_orbit_points = 1500;

std::span<const double> part(const std::vector<double>& x, std::size_t from, std::size_t to)
{
  return std::span(x).subspan(from, to - from);
}

/// Smallest and largest values over time.
struct Range {
  const std::vector<double>&t, &least, &largest;
};

/// Those within fewer windows.
Json range_json(const Range& range)
{
  std::vector<double> times, least, largest;
  const std::size_t n = std::min(range.t.size(), n_windows);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i * range.t.size() / n, to = (i + 1) * range.t.size() / n;
    times.push_back(range.t[from]);
    least.push_back(std::ranges::min(part(range.least, from, to)));
    largest.push_back(std::ranges::max(part(range.largest, from, to)));
  }
  return Json::object(
      {{"t", rounded(times)}, {"least", rounded(least)}, {"largest", rounded(largest)}});
}

/// The end of the run, sample by sample.
Json orbit_json(const squeal::History& tail)
{
  const std::size_t n = tail.t.size(), from = n - std::min(n, most_orbit_points);
  return Json::object({{"t", rounded(part(tail.t, from, n))},
                       {"displacement", rounded(part(tail.pad_displacement, from, n))},
                       {"velocity", rounded(part(tail.pad_velocity, from, n))},
                       {"N_up", rounded(part(tail.N_up, from, n))},
                       {"N_lo", rounded(part(tail.N_lo, from, n))}});
}

Json transient_json(const squeal::Transient& transient)
{
  const squeal::Windows& windows = transient.windows;
  const squeal::History& history = transient.history;
  const bool has_windows = !windows.t.empty();  // not in files of earlier versions
  const Range up = has_windows ? Range{windows.t, windows.N_up_min, windows.N_up_max}
                               : Range{history.t, history.N_up, history.N_up};
  const Range lo = has_windows ? Range{windows.t, windows.N_lo_min, windows.N_lo_max}
                               : Range{history.t, history.N_lo, history.N_lo};
  return Json::object({{"speed", rounded(transient.speed)},
                       {"integrator", transient.integrator},
                       {"t", rounded(transient.envelope.t)},
                       {"envelope", rounded(transient.envelope.pad_velocity)},
                       {"N_up", range_json(up)},
                       {"N_lo", range_json(lo)},
                       {"tail", orbit_json(transient.tail)}});
}

Json campbell_json(const squeal::EigenvalueMap& map, const ModeLooks& looks)
{
  return Json::object({{"speeds", rounded(map.speeds)},
                       {"frequency_Hz", rounded_rows(map.lambda.imag().transpose() / two_pi)},
                       {"growth", rounded_rows(map.lambda.real().transpose())},
                       {"looks", motion_looks(map, looks)}});
}

Json unstable_modes_json(const squeal::StabilityTable& table)
{
  std::vector<Json> branches;
  for (const squeal::StabilityBranch& branch : table.branches) {
    const std::optional<int> diameters = nodal_diameters(table, branch);
    const std::optional<int> circles = nodal_circles(table, branch);
    const std::optional<double> in_plane = in_plane_share(table, branch);
    std::vector<Json> unstable;
    for (const squeal::UnstableInterval& interval : branch.unstable)
      unstable.push_back(Json::array({rounded(interval.from.value), rounded(interval.to.value)}));
    branches.push_back(Json::object(
        {{"frequency_Hz", rounded(Eigen::VectorXd(branch.lambda.imag() / two_pi))},
         {"growth", rounded(Eigen::VectorXd(branch.lambda.real()))},
         {"unstable", Json::array(unstable)},
         {"worst_Hz", rounded(branch.worst.frequency_Hz)},
         {"worst_growth", rounded(branch.worst.growth)},
         {"growth_error", branch.budget.is_empty() ? Json() : rounded(branch.budget.sum())},
         {"damping_ratio", rounded(damping_ratio(branch.worst))},
         {"friction_work", branch.work ? rounded(branch.work->friction) : Json()},
         {"diameters", diameters ? Json(*diameters) : Json()},
         {"circles", circles ? Json(*circles) : Json()},
         {"in_plane", in_plane ? rounded(*in_plane) : Json()}}));
  }
  return Json::object({{"parameter", table.parameter},
                       {"unit", squeal::unit_of(table.parameter)},
                       {"values", rounded(table.values)},
                       {"summary", summary(table)},
                       {"branches", Json::array(branches)}});
}

Json map_json(const squeal::StabilityMap& map)
{
  return Json::object({{"parameter", map.parameter},
                       {"unit", squeal::unit_of(map.parameter)},
                       {"values", rounded(map.values)},
                       {"speeds", rounded(map.speeds)},
                       {"growth", rounded_rows(map.growth)},
                       {"frequency_Hz", rounded_rows(map.frequency_Hz)}});
}

Json rotation_json(const squeal::RotationStability& stability)
{
  return Json::object({{"speeds", rounded(stability.speeds)},
                       {"growth", rounded(stability.growth)},
                       {"exponents", rounded_rows(stability.exponents.real().transpose())},
                       {"frozen", rounded(stability.frozen_growth)},
                       {"method", stability.method.empty() ? "floquet" : stability.method}});
}

Json branch_json(const squeal::LimitCycleBranch& branch)
{
  std::vector<squeal::BranchPoint> points = branch.points;
  if (branch.origin) points.insert(points.begin(), branch.origin->first);
  std::vector<double> speed, velocity, frequency_Hz, multiplier;
  std::vector<Json> stability;  // a multiplier beside a Hopf point may be rounded to 1
  for (const squeal::BranchPoint& point : points) {
    stability.emplace_back(squeal::name_of(squeal::stability_of(point)));
    speed.push_back(point.speed);
    velocity.push_back(point.pad_velocity);
    frequency_Hz.push_back(point.frequency_Hz);
    multiplier.push_back(point.largest_multiplier);
  }
  const std::size_t before = branch.origin ? 1 : 0;
  return Json::object(
      {{"speed", rounded(speed)},
       {"second_part",
        branch.second_part ? Json(static_cast<int>(*branch.second_part + before)) : Json()},
       {"pad_velocity", rounded(velocity)},
       {"frequency_Hz", rounded(frequency_Hz)},
       {"stability", Json::array(stability)},
       {"largest_multiplier", rounded(multiplier)}});
}

Json growth_json(const std::vector<squeal::Growth>& growths)
{
  std::vector<Json> points;
  for (const squeal::Growth& growth : growths) {
    points.push_back(Json::object(
        {{"speed", rounded(growth.speed)}, {"rate", rounded(squeal::told_rate(growth))}}));
  }
  return Json::array(points);
}

/// Large ones only: the rest cannot be seen beside them.
Json spectrum_json(const squeal::Spectrum& spectrum)
{
  std::vector<double> f_Hz, amplitude;
  const double floor = 1e-6 * spectrum.amplitude.maxCoeff();
  for (Index i = 0; i < spectrum.amplitude.size(); ++i) {
    if (spectrum.amplitude[i] < floor) continue;
    f_Hz.push_back(spectrum.frequency_Hz[i]);
    amplitude.push_back(spectrum.amplitude[i]);
  }
  return Json::object({{"frequency_Hz", rounded(f_Hz)}, {"amplitude", rounded(amplitude)}});
}

/// What a table says of a motion that is no limit cycle which lasts; empty for one that does.
std::string doubt_of(const squeal::LimitCycle& cycle)
{
  return cycle.settled ? "" : "not settled";
}

std::string doubt_of(const squeal::DirectLimitCycle& cycle)
{
  return doubt_of_stability(squeal::stability_of(cycle));
}

Json errors_of(const squeal::LimitCycle& /*cycle*/)
{
  return Json();
}

/// What frequency and amplitudes may be off by.
Json errors_of(const squeal::DirectLimitCycle& cycle)
{
  const auto sum = [](const squeal::ErrorBudget& budget) {
    return budget.is_empty() ? Json() : rounded(budget.sum());
  };
  return Json::object({{"frequency_Hz", sum(cycle.errors.frequency_Hz)},
                       {"pad_velocity", sum(cycle.errors.pad_velocity)},
                       {"pad_displacement", sum(cycle.errors.pad_displacement)}});
}

template <class Cycle>
Json cycle_json(const Cycle& cycle)
{
  return Json::object({{"speed", rounded(cycle.speed)},
                       {"frequency_Hz", rounded(cycle.frequency_Hz)},
                       {"pad_velocity", rounded(cycle.pad_velocity)},
                       {"pad_displacement", rounded(cycle.pad_displacement)},
                       {"N_min", rounded(cycle.N_min)},
                       {"N_max", rounded(cycle.N_max)},
                       {"errors", errors_of(cycle)},
                       {"doubt", doubt_of(cycle)}});
}

}  // namespace

std::vector<Json::Member> squeal_members(const squeal::SquealResults& results,
                                         const ModeLooks& looks)
{
  std::vector<Json::Member> members;
  if (results.eigenvalues)
    members.emplace_back("campbell", campbell_json(*results.eigenvalues, looks));
  if (results.critical_speed) {
    members.emplace_back(
        "critical", Json::object({{"speed", rounded(results.critical_speed->speed)},
                                  {"frequency_Hz", rounded(results.critical_speed->frequency_Hz)},
                                  {"words", where_it_squeals(results)}}));
  }
  if (results.speed_stability) {
    members.emplace_back("stability",
                         squeal::name_of(squeal::stability_of(*results.speed_stability)));
  }
  if (results.stability_table)
    members.emplace_back("unstable_modes", unstable_modes_json(*results.stability_table));
  if (results.map) members.emplace_back("map", map_json(*results.map));
  if (results.rotation_stability)
    members.emplace_back("rotation", rotation_json(*results.rotation_stability));
  if (!results.growth.empty()) members.emplace_back("growth", growth_json(results.growth));
  if (results.transient) members.emplace_back("transient", transient_json(*results.transient));
  if (results.limit_cycle) members.emplace_back("limit_cycle", cycle_json(*results.limit_cycle));
  if (results.limit_cycle_direct)
    members.emplace_back("limit_cycle_direct", cycle_json(*results.limit_cycle_direct));
  if (results.limit_cycle_branch && !results.limit_cycle_branch->points.empty())
    members.emplace_back("branch", branch_json(*results.limit_cycle_branch));
  if (results.spectrum) members.emplace_back("spectrum", spectrum_json(*results.spectrum));
  if (results.spectrogram)
    members.emplace_back("spectrogram", spectrogram_page(*results.spectrogram));
  if (results.gradients) {
    members.emplace_back("gradients",
                         table_json("what to change", gradients_table(*results.gradients)));
  }
  if (results.motion_statistics)
    members.emplace_back("statistics", statistics_page(*results.motion_statistics));
  return members;
}

}  // namespace chladni::report
