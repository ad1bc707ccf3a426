#include "cases/squeal/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <mutex>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cases/squeal/squeal_case.hpp"
#include "common/error.hpp"
#include "report/text_table.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/numerics.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/study/study.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::cases {

using squeal::SquealResults, squeal::StudyOptions, squeal::SweepColumn, squeal::SweepTable,
    squeal::VariantState;
using std::numbers::pi;

namespace {

/// The numbers of one run in the order of the columns. A number is absent if a brake is stable or
/// an analysis has failed.
std::vector<std::optional<double>> sweep_row(const squeal::StudyOptions& study,
                                             const squeal::SquealResults& results);

using Numbers = std::vector<std::optional<double>>;

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

/// True if an analysis yields numbers that a sweep can keep.
bool has_sweep_columns(std::string_view analysis)
{
  return find_kept(analysis) != nullptr;
}

/// The numbers that a sweep keeps for each variant: a few of each analysis of the study.
/// @throws chladni::Error when an analysis yields no number to keep.
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

/// Whether pads of other options find the same modes of the body; rings have names, which do not
/// vary.
bool use_same_modes(const squeal::ModeChoice& a, const squeal::ModeChoice& b)
{
  return a.nodal_diameters == b.nodal_diameters && a.list == b.list &&
         a.quasi_static_above == b.quasi_static_above;
}

std::shared_ptr<const squeal::Brake> brake_of(const SweepCase& sweep, const scene::Scene& scene)
{
  const squeal::FlexibleDisc* const disc = sweep.brake->body();
  if (!disc || !use_same_modes(disc->options().modes, scene.squeal.value().modes))
    return sweep.make_brake(scene);
  return disc->between(*scene.squeal);
}

/// What one variant yields.
struct Outcome {
  std::vector<std::optional<double>> row;
  std::string failure;
};

Outcome outcome_of(const SweepCase& sweep, const Eigen::VectorXd& values)
{
  try {
    const Variant variant = variant_of(sweep, values);
    const squeal::SquealResults results = squeal::run(*variant.brake, variant.study);
    return {sweep_row(variant.study, results), results.failure.value_or("")};
  } catch (const std::exception& error) {
    return {{}, report::said(error)};
  }
}

void keep(SweepTable& table, Eigen::Index i, const Outcome& outcome)
{
  for (std::size_t j = 0; j < outcome.row.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    table.known(i, column) = outcome.row[j] ? 1 : 0;
    table.results(i, column) = outcome.row[j].value_or(0.0);
  }
  table.failures[static_cast<std::size_t>(i)] = outcome.failure;
  table.states[static_cast<std::size_t>(i)] =
      outcome.failure.empty() ? VariantState::done : VariantState::failed;
}

}  // namespace

Variant variant_of(const SweepCase& sweep, const Eigen::VectorXd& values)
{
  const std::string text = scene::with_numbers(
      sweep.scene.text, sweep.places, {values.data(), static_cast<std::size_t>(values.size())});
  const scene::Scene scene = scene::parse_scene(text, sweep.scene.path);
  squeal::StudyOptions study = study_of(scene);
  study.analyses = sweep.analyses;
  return {std::move(study), brake_of(sweep, scene)};
}

void check_variants(const SweepCase& sweep, const SweepTable& table)
{
  for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
    try {
      const Variant variant = variant_of(sweep, table.values.row(i));
      squeal::validate(*variant.brake, variant.study);
    } catch (const Error& error) {
      throw Error(fmt::format("variant {} ({}): {}", i + 1,
                              name_of_variant(table, static_cast<std::size_t>(i)), error.what()));
    }
  }
}

SweepTable sweep(const SweepCase& sweep, SweepTable table, const SweepKeeping& keeping)
{
  std::vector<Eigen::Index> to_do;
  for (std::size_t i = 0; i < table.n_variants(); ++i)
    if (table.states[i] == VariantState::to_do) to_do.push_back(static_cast<Eigen::Index>(i));
  std::atomic<std::size_t> next = 0;
  std::mutex keeping_one;
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  const unsigned n_threads = keeping.n_threads == 0 ? processors : keeping.n_threads;
  // Variants differ in cost: each thread takes the next one, where a loop would deal them out.
  const auto work = [&](int /*thread*/) {
    for (std::size_t k = next++; k < to_do.size(); k = next++) {
      const Outcome outcome = outcome_of(sweep, table.values.row(to_do[k]));
      const std::lock_guard lock(keeping_one);
      keep(table, to_do[k], outcome);
      if (keeping.done_another) keeping.done_another(table);
    }
  };
  squeal::for_each_index(static_cast<int>(n_threads), work, n_threads);
  return table;
}

namespace {

/// The analyses of each variant.
/// @throws chladni::Error when the scene has none of which a sweep keeps a number.
std::vector<std::string> analyses_of(const SweepRequest& request, const scene::Scene& scene)
{
  if (!request.analyses.empty()) return request.analyses;
  std::vector<std::string> analyses = study_of(scene).analyses;
  std::erase_if(analyses, [](const std::string& name) { return !has_sweep_columns(name); });
  if (analyses.empty()) {
    throw Error(
        fmt::format("{}: no analysis of the scene yields single numbers; choose others with "
                    "--analyses, as in --analyses critical-speed",
                    scene.path));
  }
  return analyses;
}

}  // namespace

SweepStudy sweep_study(const SweepRequest& request, const std::string& scene_file)
{
  const SweepValues& wanted = request.values;
  const scene::Scene scene = scene::read_scene(request.scene);
  require_study(scene);
  std::vector<std::vector<scene::NumberPlace>> places;
  for (const std::string& key : wanted.keys)
    places.push_back(scene::places_of_squeal_key(scene, key));
  squeal::StudyOptions options = study_of(scene);
  options.analyses = analyses_of(request, scene);
  squeal::SweepTable table =
      squeal::empty_sweep(wanted.keys, wanted.values, sweep_columns(options));
  const SquealFiles files = squeal_files(scene, request.folder, request.body);
  const auto body = body_for_squeal(scene, files, request.stale);
  SquealCase brake_case = squeal_case(scene, body, files, request.stale);
  squeal::RunOrigin origin = squeal_origin(scene, body, files, scene_file);
  table.inputs = origin.inputs;
  const auto make_brake = [body, files](const scene::Scene& variant) {
    return std::shared_ptr<const squeal::Brake>(
        squeal_case(variant, body, files, std::nullopt).brake);
  };
  return {.sweep = {scene, options.analyses, std::move(places), std::move(brake_case.brake),
                    make_brake},
          .table = std::move(table),
          .origin = std::move(origin),
          .notes = std::move(brake_case.notes)};
}

namespace {

std::string_view trimmed(std::string_view text)
{
  const std::size_t from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

std::vector<std::string_view> parts_of(std::string_view text, char separator)
{
  std::vector<std::string_view> parts;
  for (std::size_t at = text.find(separator); at != std::string_view::npos;
       at = text.find(separator)) {
    parts.push_back(trimmed(text.substr(0, at)));
    text.remove_prefix(at + 1);
  }
  parts.push_back(trimmed(text));
  return parts;
}

std::optional<double> finite_number(std::string_view text)
{
  double x = 0.0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc{} || rest != text.data() + text.size() || !std::isfinite(x))
    return std::nullopt;
  return x;
}

/// The numbers of "FROM:TO:COUNT" or "VALUE,VALUE,..."; nothing for any other text.
std::optional<std::vector<double>> values_of(std::string_view text)
{
  const bool is_range = text.find(':') != std::string_view::npos;
  std::vector<double> values;
  for (const std::string_view part : parts_of(text, is_range ? ':' : ',')) {
    const std::optional<double> x = finite_number(part);
    if (!x) return std::nullopt;
    values.push_back(*x);
  }
  if (!is_range) return values;
  if (values.size() != 3 || !(values[2] >= 1.0) || values[2] != std::floor(values[2]) ||
      values[2] > variants_max)
    return std::nullopt;
  const Eigen::VectorXd spaced =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(values[2]), values[0], values[1]);
  return std::vector<double>(spaced.begin(), spaced.end());
}

void refuse_twice(const std::vector<std::string>& keys, const std::string& place)
{
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (std::ranges::count(keys, keys[i]) > 1)
      throw Error(fmt::format("{}: {} is there twice", place, keys[i]));
}

std::vector<double> row_of(std::string_view line, std::size_t n_keys, const std::string& place)
{
  const std::vector<std::string_view> cells = parts_of(line, ',');
  if (cells.size() != n_keys)
    throw Error(fmt::format("{}: has {} numbers for {} keys", place, cells.size(), n_keys));
  std::vector<double> row;
  for (const std::string_view cell : cells) {
    const std::optional<double> x = finite_number(cell);
    if (!x) throw Error(fmt::format("{}: \"{}\" is no finite number", place, cell));
    row.push_back(*x);
  }
  return row;
}

/// The grid of the axes, the last one fastest.
files::RowMajorMatrix product(const std::vector<std::vector<double>>& axes, std::size_t n)
{
  files::RowMajorMatrix values(static_cast<Eigen::Index>(n), std::ssize(axes));
  std::size_t period = n;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    period /= axes[k].size();
    for (std::size_t i = 0; i < n; ++i) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          axes[k][i / period % axes[k].size()];
    }
  }
  return values;
}

}  // namespace

SweepValues sweep_grid(const std::vector<std::string>& words)
{
  SweepValues sweep;
  std::vector<std::vector<double>> axes;
  double n = 1.0;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string key(trimmed(std::string_view(word).substr(0, equals)));
    std::optional<std::vector<double>> values;
    if (equals != std::string::npos) values = values_of(std::string_view(word).substr(equals + 1));
    if (key.empty() || !values) {
      throw Error(
          fmt::format("--vary {}: give KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., as in "
                      "squeal.friction=0.3:0.6:10",
                      word));
    }
    n *= double(values->size());
    sweep.keys.push_back(key);
    axes.push_back(std::move(*values));
  }
  refuse_twice(sweep.keys, "--vary");
  if (n > variants_max)
    throw Error(fmt::format("--vary: {:.0f} variants; at most {:.0f}", n, variants_max));
  sweep.values = product(axes, static_cast<std::size_t>(n));
  return sweep;
}

SweepValues read_samples(const std::string& file)
{
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) {
    throw Error(
        fmt::format("{}: cannot be read; give a file whose first line is keys of the scene, "
                    "separated by commas, and whose others are numbers",
                    file));
  }
  SweepValues sweep;
  for (const std::string_view key : parts_of(line, ',')) sweep.keys.emplace_back(key);
  refuse_twice(sweep.keys, file + ":1");
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 2; std::getline(stream, line); ++i) {
    if (trimmed(line).empty()) continue;
    rows.push_back(row_of(line, sweep.keys.size(), fmt::format("{}:{}", file, i)));
    if (double(rows.size()) > variants_max)
      throw Error(fmt::format("{}: more than {:.0f} variants", file, variants_max));
  }
  if (rows.empty()) throw Error(fmt::format("{}: has keys, but no line of numbers", file));
  sweep.values.resize(std::ssize(rows), std::ssize(sweep.keys));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sweep.values.row(static_cast<Eigen::Index>(i)) =
        Eigen::RowVectorXd::Map(rows[i].data(), std::ssize(rows[i]));
  }
  return sweep;
}

}  // namespace chladni::cases
