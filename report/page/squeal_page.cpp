#include "report/page/squeal_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "common/error.hpp"
#include "report/describe_squeal.hpp"
#include "report/json.hpp"
#include "report/page/page.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/transient_results.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::report {

using Eigen::Index;

namespace {

/// The statistics of a motion over the last rotations for the page: figures, spectral lines, and
/// the effective pad velocity over the disc's angle.
Json statistics_page(const squeal::MotionStatistics& statistics)
{
  std::vector<Json> lines;
  for (const squeal::MotionStatistics::Line& line : statistics.lines) {
    lines.push_back(Json::object({{"frequency_Hz", rounded(line.frequency_Hz)},
                                  {"amplitude", rounded(line.amplitude)},
                                  {"rotations", rounded(line.rotations)}}));
  }
  return Json::object({{"speed", rounded(statistics.speed)},
                       {"n_rotations", double(statistics.n_rotations)},
                       {"rms_velocity", rounded(statistics.rms_velocity)},
                       {"peak_velocity", rounded(statistics.peak_velocity)},
                       {"peak_displacement", rounded(statistics.peak_displacement)},
                       {"N_min", rounded(statistics.N_min)},
                       {"N_max", rounded(statistics.N_max)},
                       {"modulation", rounded(statistics.modulation)},
                       {"doubt", statistics.settled ? "" : "not settled"},
                       {"rms_over_angle", rounded(statistics.rms_over_angle)},
                       {"lines", Json::array(lines)}});
}

constexpr double range_dB = 60.0;

constexpr Index frequencies_max = 320, times_max = 120;

/// The largest amplitude of each block of times and frequencies, in dB above the floor.
Eigen::MatrixXd levels(const squeal::Spectrogram& of, Index every_t, Index every_f)
{
  const double floor = of.amplitude.maxCoeff() * std::pow(10.0, -range_dB / 20.0);
  const Index n_t = of.amplitude.rows() / every_t, n_f = of.amplitude.cols() / every_f;
  Eigen::MatrixXd dB(n_f, n_t);
  for (Index i = 0; i < n_f; ++i)
    for (Index k = 0; k < n_t; ++k) {
      const double a =
          of.amplitude.block(k * every_t, i * every_f, every_t, every_f).maxCoeff() / floor;
      const double level = std::max(-range_dB, 20.0 * std::log10(std::max(a, 1e-9)));
      dB(i, k) = std::round(10.0 * level) / 10.0;  // shorter in the page
    }
  return dB;
}

/// The spectrogram in decibels, thinned for a page, with the frequencies of its lines.
Json spectrogram_page(const squeal::Spectrogram& spectrogram)
{
  const squeal::Spectrogram& of = spectrogram;
  const Index every_t = (of.t.size() + times_max - 1) / times_max,
              every_f = (of.frequency_Hz.size() + frequencies_max - 1) / frequencies_max;
  const auto some = [](const Eigen::VectorXd& x, Index every) -> Eigen::VectorXd {
    return x(Eigen::seqN(0, x.size() / every, every));
  };
  std::vector<Json> lines;
  for (Index j = 0; j < of.line_Hz.cols(); ++j) {
    // Lines a thousandth as strong as the strongest of their window are left out.
    const auto weak = of.line_amplitude.col(j).array() < 1e-3 * of.line_amplitude.col(0).array();
    const Eigen::VectorXd f_Hz =
        weak.select(std::numeric_limits<double>::quiet_NaN(), of.line_Hz.col(j));
    lines.push_back(rounded(f_Hz));
  }
  Eigen::VectorXd t = some(of.t, every_t);
  return Json::object({{"map_t", rounded(t)},
                       {"t", rounded(of.t)},
                       {"speed", rounded(of.speed)},
                       {"envelope", rounded(of.envelope)},
                       {"frequency_Hz", rounded(some(of.frequency_Hz, every_f))},
                       {"level_dB", rounded_rows(levels(of, every_t, every_f))},
                       {"range_dB", range_dB},
                       {"line_Hz", Json::array(lines)}});
}

using std::numbers::pi;
constexpr std::size_t n_windows = 600;  ///< of a thinned history
constexpr std::size_t most_orbit_points = 1500;

std::span<const double> part(const std::vector<double>& x, std::size_t from, std::size_t to)
{
  return std::span(x).subspan(from, to - from);
}

/// Smallest and largest values over time.
struct ForceRange {
  const std::vector<double>&t, &least, &largest;
};

/// Those within fewer windows.
Json range_json(const ForceRange& range)
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
  const ForceRange up = has_windows ? ForceRange{windows.t, windows.N_up_min, windows.N_up_max}
                                    : ForceRange{history.t, history.N_up, history.N_up};
  const ForceRange lo = has_windows ? ForceRange{windows.t, windows.N_lo_min, windows.N_lo_max}
                                    : ForceRange{history.t, history.N_lo, history.N_lo};
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
                       {"frequency_Hz", rounded_rows(map.lambda.imag().transpose() / (2.0 * pi))},
                       {"growth", rounded_rows(map.lambda.real().transpose())},
                       {"of", map.of},
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
        {{"frequency_Hz", rounded(Eigen::VectorXd(branch.lambda.imag() / (2.0 * pi)))},
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

Json rotation_of_page(const squeal::RotationStability& stability)
{
  return Json::object({{"speeds", rounded(stability.speeds)},
                       {"growth", rounded(stability.growth)},
                       {"exponents", rounded_rows(stability.exponents.real().transpose())},
                       {"frozen", rounded(stability.frozen_growth)},
                       {"method", stability.method.empty() ? "floquet" : stability.method}});
}

Json branch_of_page(const squeal::LimitCycleBranch& branch)
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

Json growth_of_page(const std::vector<squeal::Growth>& growths)
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
  if (results.frozen_eigenvalues)
    members.emplace_back("frozen", campbell_json(*results.frozen_eigenvalues, looks));
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
    members.emplace_back("rotation", rotation_of_page(*results.rotation_stability));
  if (!results.growth.empty()) members.emplace_back("growth", growth_of_page(results.growth));
  if (results.transient) members.emplace_back("transient", transient_json(*results.transient));
  if (results.limit_cycle) members.emplace_back("limit_cycle", cycle_json(*results.limit_cycle));
  if (results.limit_cycle_direct)
    members.emplace_back("limit_cycle_direct", cycle_json(*results.limit_cycle_direct));
  if (results.limit_cycle_branch && !results.limit_cycle_branch->points.empty())
    members.emplace_back("branch", branch_of_page(*results.limit_cycle_branch));
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

namespace {

/// Amplitudes of the modes used, among all modes of the body.
/// @throws chladni::Error when the body has no such modes: the results are of another one.
Eigen::VectorXcd spread(const Eigen::VectorXcd& amplitude, const std::vector<int>& mode_numbers,
                        Index n_modes)
{
  if (amplitude.size() != std::ssize(mode_numbers)) {
    throw Error(
        fmt::format("the results of squeal have {} modes, and the study {}: body or study have "
                    "changed since; make them again with `squeal run`",
                    amplitude.size(), mode_numbers.size()));
  }
  for (const int number : mode_numbers) {
    if (number >= 1 && number <= n_modes) continue;
    throw Error(
        fmt::format("the results of squeal name mode {}, and the body has {}: they are of another "
                    "body; make them again with `squeal run`",
                    number, n_modes));
  }
  Eigen::VectorXcd all = Eigen::VectorXcd::Zero(n_modes);
  for (std::size_t i = 0; i < mode_numbers.size(); ++i)
    all[mode_numbers[i] - 1] = amplitude[static_cast<Index>(i)];
  return all;
}

template <class Cycle>
void add_cycle(std::vector<Motion>& motions, const std::optional<Cycle>& cycle, Index n_modes)
{
  if (!cycle || cycle->amplitude.size() == 0) return;
  motions.push_back({.name = name_of(*cycle),
                     .frequency_Hz = cycle->frequency_Hz,
                     .amplitude = spread(cycle->amplitude, cycle->mode_numbers, n_modes)});
}

}  // namespace

std::vector<Motion> squeal_motions(const squeal::SquealResults& results,
                                   const std::vector<int>& mode_numbers, Index n_modes)
{
  std::vector<Motion> motions;
  // The first one is shown first.
  const bool unsettled = squeal::has_unsettled_end(results);
  if (!unsettled) add_cycle(motions, results.limit_cycle, n_modes);
  add_cycle(motions, results.limit_cycle_direct, n_modes);
  if (unsettled) add_cycle(motions, results.limit_cycle, n_modes);
  if (!results.eigenvalues || results.eigenvalues->shapes.empty()) return motions;
  const squeal::EigenvalueMap& map = *results.eigenvalues;
  Index i = 0, j = 0;
  const double growth = map.lambda.real().maxCoeff(&i, &j);
  const Eigen::VectorXcd shape = map.shapes[static_cast<std::size_t>(i)].col(j);
  const double f_Hz = map.lambda(i, j).imag() / (2.0 * pi);
  const std::vector<int>& numbers = map.mode_numbers.empty() ? mode_numbers : map.mode_numbers;
  // Behind the modes of the body are the displacements of pads with a mass.
  const Index n = map.mode_numbers.empty() ? shape.size() : std::ssize(map.mode_numbers);
  motions.push_back(
      {.name = fmt::format("Least stable at {:.5g} rad/s, {:+.3g} 1/s", map.speeds[i], growth),
       .frequency_Hz = f_Hz,
       .amplitude = spread(shape.head(n), numbers, n_modes)});
  return motions;
}

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
