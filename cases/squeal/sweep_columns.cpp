#include "cases/squeal/sweep_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "squeal/results/analysis_file.hpp"
#include "squeal/transient/growth_rate.hpp"

namespace chladni::cases {
namespace {

using squeal::SquealResults, squeal::StudyOptions, squeal::SweepColumn;
using Numbers = std::vector<std::optional<double>>;
using std::numbers::pi;

/// The largest growth rate among some motions, where it was found, and its frequency.
struct Worst {
  std::optional<double> growth, value, frequency_Hz;

  void consider(double growth_there, double at, double f_Hz)
  {
    if (growth && *growth >= growth_there) return;
    growth = growth_there;
    value = at;
    frequency_Hz = f_Hz;
  }
  Numbers numbers() const { return {growth, value, frequency_Hz}; }
};

/// @param at  what it was found over: "speed", or the key of a parameter
std::vector<SweepColumn> worst_columns(const std::string& what, const std::string& at)
{
  const std::string unit = at == "speed" ? "_rad_s" : "";
  return {{what + "_growth_1_s", "1/s"},
          {fmt::format("{}_growth_at_{}{}", what, at, unit), squeal::unit_of(at)},
          {what + "_growth_frequency_Hz", "Hz"}};
}

/// The columns of `first`, then those of `then`.
std::vector<SweepColumn> joined(std::vector<SweepColumn> first, std::vector<SweepColumn> then)
{
  std::ranges::move(then, std::back_inserter(first));
  return first;
}

std::vector<SweepColumn> critical_columns(const StudyOptions& /*study*/)
{
  return joined({{"critical_speed_rad_s", "rad/s"},
                 {"critical_frequency_Hz", "Hz"},
                 {"n_unstable_intervals", "1"}},
                worst_columns("unstable", "speed"));
}

Numbers critical_numbers(const StudyOptions& /*study*/, const SquealResults& results)
{
  if (!results.speed_stability) return Numbers(6);
  Numbers row(2);
  if (const auto& critical = results.critical_speed)
    row = {critical->speed, critical->frequency_Hz};
  row.push_back(double(results.speed_stability->unstable.size()));
  Worst worst;
  for (const squeal::UnstableInterval& interval : results.speed_stability->unstable)
    worst.consider(interval.worst.growth, interval.worst.value, interval.worst.frequency_Hz);
  std::ranges::copy(worst.numbers(), std::back_inserter(row));
  return row;
}

std::vector<SweepColumn> eigenvalue_columns(const StudyOptions& /*study*/)
{
  return worst_columns("eigenvalues", "speed");
}

Numbers eigenvalue_numbers(const StudyOptions& /*study*/, const SquealResults& results)
{
  Worst worst;
  if (const auto& map = results.eigenvalues) {
    for (Eigen::Index i = 0; i < map->lambda.rows(); ++i)
      for (Eigen::Index j = 0; j < map->lambda.cols(); ++j) {
        worst.consider(map->lambda(i, j).real(), map->speeds[i],
                       map->lambda(i, j).imag() / (2.0 * pi));
      }
  }
  return worst.numbers();
}

std::vector<SweepColumn> stability_columns(const StudyOptions& study)
{
  const bool over_speed = !study.stability || !study.stability->over;
  return joined({{"n_unstable_modes", "1"}},
                worst_columns("stability", over_speed ? "speed" : key_of(*study.stability->over)));
}

Numbers stability_numbers(const StudyOptions& /*study*/, const SquealResults& results)
{
  const auto& table = results.stability_table;
  if (!table) return Numbers(4);
  Worst worst;
  for (const squeal::StabilityBranch& branch : table->branches)
    worst.consider(branch.worst.growth, branch.worst.value, branch.worst.frequency_Hz);
  Numbers row = {
      double(std::ranges::count_if(table->branches, &squeal::StabilityBranch::is_unstable))};
  std::ranges::copy(worst.numbers(), std::back_inserter(row));
  return row;
}

std::vector<SweepColumn> value_columns(const StudyOptions& study)
{
  std::vector<SweepColumn> columns;
  for (std::size_t i = 1; i <= study.critical.size(); ++i) {
    const std::string name =
        fmt::format("critical_{}_{}", i, key_of(study.critical[i - 1].parameter));
    columns.push_back({name, squeal::unit_of(key_of(study.critical[i - 1].parameter))});
    columns.push_back({name + "_frequency_Hz", "Hz"});
  }
  return columns;
}

Numbers value_numbers(const StudyOptions& study, const SquealResults& results)
{
  Numbers row(2 * study.critical.size());
  for (std::size_t i = 0; i < results.critical_values.size(); ++i) {
    if (!results.critical_values[i].value) continue;
    row[2 * i] = results.critical_values[i].value;
    row[2 * i + 1] = results.critical_values[i].frequency_Hz;
  }
  return row;
}

std::vector<SweepColumn> rotation_columns(const StudyOptions& /*study*/)
{
  return joined({{"rotation_critical_speed_rad_s", "rad/s"}}, worst_columns("rotation", "speed"));
}

Numbers rotation_numbers(const StudyOptions& /*study*/, const SquealResults& results)
{
  const auto& found = results.rotation_stability;
  if (!found) return Numbers(4);
  Worst worst;
  for (Eigen::Index i = 0; i < found->speeds.size(); ++i)
    worst.consider(found->growth[i], found->speeds[i], found->frequency_Hz[i]);
  Numbers row = {found->critical_speed};
  std::ranges::copy(worst.numbers(), std::back_inserter(row));
  return row;
}

std::vector<SweepColumn> growth_columns(const StudyOptions& study)
{
  std::vector<SweepColumn> columns;
  for (std::size_t i = 1; i <= study.growth.value().speeds.size(); ++i)
    columns.push_back({fmt::format("growth_{}_1_s", i), "1/s"});
  return columns;
}

Numbers growth_numbers(const StudyOptions& study, const SquealResults& results)
{
  Numbers row(study.growth.value().speeds.size());
  for (std::size_t i = 0; i < results.growth.size(); ++i)
    row[i] = squeal::told_rate(results.growth[i]);
  return row;
}

/// Of a cycle by either analysis.
std::vector<SweepColumn> cycle_columns(const std::string& analysis)
{
  return {{analysis + "_frequency_Hz", "Hz"},
          {analysis + "_pad_velocity_m_s", "m/s"},
          {analysis + "_pad_displacement_m", "m"}};
}

template <class Cycle>
Numbers cycle_numbers(const std::optional<Cycle>& cycle)
{
  if (!cycle) return Numbers(3);
  return {cycle->frequency_Hz, cycle->pad_velocity, cycle->pad_displacement};
}

/// What a sweep keeps of an analysis.
struct Kept {
  std::string_view analysis;
  std::vector<SweepColumn> (*columns)(const StudyOptions&);
  Numbers (*numbers)(const StudyOptions&, const SquealResults&);
};

const Kept all_kept[] = {
    {"critical-speed", critical_columns, critical_numbers},
    {"stability", stability_columns, stability_numbers},
    {"eigenvalues", eigenvalue_columns, eigenvalue_numbers},
    {"critical-values", value_columns, value_numbers},
    {"rotation-stability", rotation_columns, rotation_numbers},
    {"growth", growth_columns, growth_numbers},
    {"limit-cycle", [](const StudyOptions&) { return cycle_columns("limit_cycle"); },
     [](const StudyOptions&, const SquealResults& at) { return cycle_numbers(at.limit_cycle); }},
    {"limit-cycle-direct", [](const StudyOptions&) { return cycle_columns("limit_cycle_direct"); },
     [](const StudyOptions&, const SquealResults& at) {
       return cycle_numbers(at.limit_cycle_direct);
     }}};

const Kept* find_kept(std::string_view analysis)
{
  const auto* const found = std::ranges::find(all_kept, analysis, &Kept::analysis);
  return found != std::end(all_kept) ? found : nullptr;
}

const Kept& kept_of(const std::string& analysis)
{
  if (const Kept* const found = find_kept(analysis)) return *found;
  std::string names;
  for (const Kept& kept : all_kept)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", kept.analysis);
  throw Error(
      fmt::format("analyses: a sweep keeps no numbers of \"{}\"; it takes {}", analysis, names));
}

}  // namespace

bool has_sweep_columns(std::string_view analysis)
{
  return find_kept(analysis) != nullptr;
}

std::vector<SweepColumn> sweep_columns(const StudyOptions& study)
{
  std::vector<SweepColumn> columns;
  for (const std::string& analysis : study.analyses)
    columns = joined(std::move(columns), kept_of(analysis).columns(study));
  return columns;
}

Numbers sweep_row(const StudyOptions& study, const SquealResults& results)
{
  Numbers row;
  for (const std::string& analysis : study.analyses)
    std::ranges::copy(kept_of(analysis).numbers(study, results), std::back_inserter(row));
  return row;
}

}  // namespace chladni::cases
