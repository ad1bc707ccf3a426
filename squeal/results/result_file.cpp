#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <cstdint>
#include <set>
#include <span>
#include <utility>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/result_fields.hpp"

namespace chladni::squeal {

using Eigen::Index;
using files::read_fields, files::read_rows, files::write_fields, files::write_rows;
using files::Reader, files::Writer;

void check_times(const Reader& file, const std::string& name, const std::vector<double>& t)
{
  if (!std::ranges::is_sorted(t)) file.fail(name, "expected times in ascending order");
}

void check_modes(const Reader& file, const std::string& name, const std::vector<int>& numbers)
{
  std::set<int> seen;
  for (const int number : numbers) {
    if (number == 0) file.fail(name, "names mode 0, expected numbers from 1");
    if (!seen.insert(number).second) file.fail(name, fmt::format("names mode {} twice", number));
  }
}

void check_some(const Reader& file, const std::string& name, const Eigen::VectorXd& x)
{
  if (x.size() == 0) file.fail(name, "is empty, expected one value at least");
}

void check_state(const Reader& file, const std::string& name, const Eigen::VectorXd& x)
{
  if (x.size() < 2) file.fail(name, "expected a displacement and a velocity at least");
}

namespace {

constexpr std::int64_t results_version = 1;
constexpr std::complex<double> i_unit(0.0, 1.0);

// Stability over a parameter.

void write_intervals(Writer& file, const std::string& group,
                     const std::vector<UnstableInterval>& intervals, const std::string& unit)
{
  if (!intervals.empty()) write_rows(file, group, intervals, unit);
}

std::vector<UnstableInterval> read_intervals(const Reader& file, const std::string& group)
{
  if (!file.contains(group + "/from/values")) return {};
  return read_rows<UnstableInterval>(file, group);
}

/// @param unit  of the parameter
void write_profile(Writer& file, const std::string& group, const StabilityProfile& profile,
                   const std::string& unit)
{
  file.write(group + "/stability", std::string(name_of(stability_of(profile))));
  if (!profile.method.empty()) file.write(group + "/method", profile.method);
  write_rows(file, group + "/range", std::vector{profile.from, profile.to}, unit);
  write_intervals(file, group + "/unstable", profile.unstable, unit);
}

/// Files of earlier versions have none.
std::optional<StabilityProfile> read_profile(const Reader& file, const std::string& group)
{
  if (!file.contains(group + "/range/values")) return std::nullopt;
  const auto range = read_rows<StabilityPoint>(file, group + "/range", 2);
  return StabilityProfile{range[0], range[1], read_intervals(file, group + "/unstable"),
                          file.contains(group + "/method") ? file.text(group + "/method") : ""};
}

void write_critical_values(Writer& file, const std::vector<CriticalValue>& values)
{
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string group = fmt::format("critical_values/{}", i + 1);
    const CriticalValue& value = values[i];
    file.write(group + "/parameter", value.parameter);
    file.write(group + "/speed", value.speed, "rad/s");
    if (value.profile) write_profile(file, group, *value.profile, unit_of(value.parameter));
    if (!value.value) continue;
    file.write(group + "/value", *value.value, unit_of(value.parameter));
    file.write(group + "/frequency", value.frequency_Hz, "Hz");
    file.write(group + "/newton_steps", std::int64_t{value.n_newton_steps}, "1");
  }
}

std::vector<CriticalValue> read_critical_values(const Reader& file)
{
  std::vector<CriticalValue> values;
  for (int i = 1; file.contains(fmt::format("critical_values/{}", i)); ++i) {
    const std::string group = fmt::format("critical_values/{}", i);
    CriticalValue value{.parameter = file.text(group + "/parameter"),
                        .speed = file.real(group + "/speed"),
                        .value = {},
                        .frequency_Hz = 0.0,
                        .n_newton_steps = 0,
                        .profile = read_profile(file, group)};
    if (file.contains(group + "/value")) {
      value.value = file.real(group + "/value");
      value.frequency_Hz = file.real(group + "/frequency");
      value.n_newton_steps = mbs_export::file_parts::read_count(file, group + "/newton_steps");
    }
    values.push_back(value);
  }
  return values;
}

std::string shape_group(const std::string& group, std::size_t i)
{
  return fmt::format("{}/shapes/{}", group, i + 1);
}

void write_eigenvalues(Writer& file, const std::string& group, const EigenvalueMap& map)
{
  file.write(group + "/speeds", map.speeds, "rad/s");
  file.write(group + "/lambda_re", map.lambda.real(), "1/s");
  file.write(group + "/lambda_im", map.lambda.imag(), "rad/s");
  if (!map.of.empty()) file.write(group + "/of", map.of);
  if (map.angles.size() > 0) file.write(group + "/angles", map.angles, "rad");
  if (!map.mode_numbers.empty())
    file.write(group + "/mode_numbers", std::span<const int>(map.mode_numbers), "1");
  for (std::size_t i = 0; i < map.shapes.size(); ++i) {
    file.write(shape_group(group, i) + "/re", map.shapes[i].real(), "1");
    file.write(shape_group(group, i) + "/im", map.shapes[i].imag(), "1");
  }
}

EigenvalueMap read_eigenvalues(const Reader& file, const std::string& group)
{
  const Eigen::VectorXd speeds = file.vector(group + "/speeds");
  const Eigen::MatrixXd re = file.matrix(group + "/lambda_re", {speeds.size()});
  const Eigen::MatrixXd im = file.matrix(group + "/lambda_im", {speeds.size(), re.cols()});
  if (re.size() == 0) file.fail(group + "/lambda_re", "it must have a value at each speed");
  EigenvalueMap map{speeds, re + i_unit * im};
  if (file.contains(group + "/of")) map.of = file.text(group + "/of");
  if (file.contains(group + "/angles")) map.angles = file.vector(group + "/angles", speeds.size());
  const std::string numbers = group + "/mode_numbers";
  if (file.contains(numbers)) {
    map.mode_numbers = files::read_counts(file, numbers);
    check_modes(file, numbers, map.mode_numbers);
  }
  for (std::size_t i = 0; file.contains(shape_group(group, i)); ++i) {
    const std::string name = shape_group(group, i);
    const Eigen::MatrixXd shape = file.matrix(name + "/re", {files::any, re.cols()});
    if (shape.rows() < std::ssize(map.mode_numbers))
      file.fail(name + "/re", fmt::format("expected a row for each of {}", numbers));
    map.shapes.emplace_back(shape +
                            i_unit * file.matrix(name + "/im", {shape.rows(), shape.cols()}));
  }
  if (!map.shapes.empty() && std::ssize(map.shapes) != speeds.size())
    file.fail(group + "/shapes", "there must be those of each speed");
  return map;
}

// The table of branches.

void write_participation(Writer& file, const StabilityTable& table)
{
  if (table.families.empty()) return;
  write_rows(file, "stability/families", table.families);
  const auto n = std::ssize(table.families), m = std::ssize(table.branches);
  if (m == 0) return;
  Eigen::VectorXd pads(m);
  Eigen::MatrixXd shares(m, n);
  for (Index j = 0; j < m; ++j) {
    shares.row(j) = table.branches[static_cast<std::size_t>(j)].shares.transpose();
    pads[j] = table.branches[static_cast<std::size_t>(j)].pads;
  }
  file.write("stability/shares", shares, "1");
  file.write("stability/pads", pads, "1");
}

/// The works of those branches that have some, and which these are.
void write_works(Writer& file, const StabilityTable& table)
{
  std::vector<std::int64_t> of;
  std::vector<PeriodWork> works;
  for (std::size_t j = 0; j < table.branches.size(); ++j) {
    if (!table.branches[j].work) continue;
    of.push_back(static_cast<std::int64_t>(j) + 1);
    works.push_back(*table.branches[j].work);
  }
  if (of.empty()) return;
  file.write("stability/work/branch", std::span<const std::int64_t>(of), "1");
  write_rows(file, "stability/work", works);
}

/// Each part that is known of a branch; -1 stands for what is unknown.
void write_errors(Writer& file, const StabilityTable& table)
{
  files::for_each_field<ErrorBudget>([&](const auto& part) {
    std::vector<double> errors;
    for (const StabilityBranch& branch : table.branches)
      errors.push_back((branch.budget.*part.member).value_or(-1.0));
    if (std::ranges::all_of(errors, [](double error) { return error < 0.0; })) return;
    file.write(fmt::format("stability/errors/{}", part.name), errors, "1/s");
  });
}

void read_errors(const Reader& file, std::vector<StabilityBranch>& branches)
{
  files::for_each_field<ErrorBudget>([&](const auto& part) {
    const std::string path = fmt::format("stability/errors/{}", part.name);
    if (!file.contains(path)) return;
    const Eigen::VectorXd errors = file.vector(path, std::ssize(branches));
    for (Index j = 0; j < errors.size(); ++j)
      if (errors[j] >= 0.0) branches[static_cast<std::size_t>(j)].budget.*part.member = errors[j];
  });
}

void write_branches(Writer& file, const StabilityTable& table, const std::string& unit)
{
  const auto m = std::ssize(table.branches);
  Eigen::MatrixXcd lambda(m, table.values.size());
  std::vector<StabilityPoint> worst;
  std::vector<UnstableInterval> unstable;
  std::vector<std::int64_t> of;
  for (Index j = 0; j < m; ++j) {
    const StabilityBranch& branch = table.branches[static_cast<std::size_t>(j)];
    lambda.row(j) = branch.lambda.transpose();
    worst.push_back(branch.worst);
    unstable.insert(unstable.end(), branch.unstable.begin(), branch.unstable.end());
    of.insert(of.end(), branch.unstable.size(), j + 1);
  }
  file.write("stability/growth", Eigen::MatrixXd(lambda.real()), "1/s");
  file.write("stability/angular_frequency", Eigen::MatrixXd(lambda.imag()), "rad/s");
  write_rows(file, "stability/worst", worst, unit);
  if (unstable.empty()) return;
  write_intervals(file, "stability/unstable", unstable, unit);
  file.write("stability/unstable/branch", std::span<const std::int64_t>(of), "1");
}

/// The branch of each of n rows.
std::vector<StabilityBranch*> branches_of(const Reader& file, const std::string& name,
                                          std::ptrdiff_t n, std::vector<StabilityBranch>& branches)
{
  std::vector<StabilityBranch*> of;
  for (const std::int64_t number : file.integers(name, n)) {
    if (number < 1 || number > std::ssize(branches))
      file.fail(name, "it must number a row of stability/growth, from 1");
    of.push_back(&branches[static_cast<std::size_t>(number - 1)]);
  }
  return of;
}

std::vector<StabilityBranch> read_branches(const Reader& file, Index n_values, Index n_families)
{
  std::vector<StabilityBranch> branches;
  if (!file.contains("stability/growth")) return branches;
  const Eigen::MatrixXd growth = file.matrix("stability/growth", {files::any, n_values});
  const Index m = growth.rows();
  const Eigen::MatrixXd omega = file.matrix("stability/angular_frequency", {m, n_values});
  const auto worst = read_rows<StabilityPoint>(file, "stability/worst", m);
  const bool has_shares = n_families > 0;
  const Eigen::MatrixXd shares =
      has_shares ? file.matrix("stability/shares", {m, n_families}) : Eigen::MatrixXd(m, 0);
  const Eigen::VectorXd pads =
      has_shares ? file.vector("stability/pads", m) : Eigen::VectorXd(Eigen::VectorXd::Zero(m));
  for (Index j = 0; j < m; ++j) {
    branches.push_back({.lambda = (growth.row(j) + i_unit * omega.row(j)).transpose(),
                        .unstable = {},
                        .worst = worst[static_cast<std::size_t>(j)],
                        .shares = shares.row(j).transpose(),
                        .pads = pads[j]});
  }
  const std::vector<UnstableInterval> unstable = read_intervals(file, "stability/unstable");
  if (!unstable.empty()) {
    const auto of = branches_of(file, "stability/unstable/branch", std::ssize(unstable), branches);
    for (std::size_t i = 0; i < of.size(); ++i) of[i]->unstable.push_back(unstable[i]);
  }
  if (file.contains("stability/work")) {
    const auto works = read_rows<PeriodWork>(file, "stability/work");
    const auto of = branches_of(file, "stability/work/branch", std::ssize(works), branches);
    for (std::size_t i = 0; i < of.size(); ++i) of[i]->work = works[i];
  }
  read_errors(file, branches);
  return branches;
}

void write_stability_table(Writer& file, const StabilityTable& table)
{
  const std::string unit = unit_of(table.parameter);
  file.write("stability/parameter", table.parameter);
  file.write("stability/values", table.values, unit);
  if (table.speed) file.write("stability/speed", *table.speed, "rad/s");
  if (table.band) {
    file.write("stability/band",
               Eigen::VectorXd(Eigen::Vector2d(table.band->from_Hz, table.band->to_Hz)), "Hz");
  }
  if (!table.method.empty()) file.write("stability/method", table.method);
  if (table.is_by_hill()) file.write("stability/error", table.error, "1/s");
  write_participation(file, table);
  if (table.branches.empty()) return;
  write_branches(file, table, unit);
  write_works(file, table);
  write_errors(file, table);
}

std::optional<double> read_if(const Reader& file, const std::string& name)
{
  return file.contains(name) ? std::optional(file.real(name)) : std::nullopt;
}

StabilityTable read_stability_table(const Reader& file)
{
  StabilityTable table{.parameter = file.text("stability/parameter"),
                       .speed = read_if(file, "stability/speed"),
                       .band = {},
                       .values = file.vector("stability/values"),
                       .families = {},
                       .branches = {}};
  check_some(file, "stability/values", table.values);
  if (file.contains("stability/families"))
    table.families = read_rows<ModeFamily>(file, "stability/families");
  if (file.contains("stability/band")) {
    const Eigen::VectorXd band = file.vector("stability/band", 2);
    table.band = FrequencyBand{band[0], band[1]};
  }
  if (file.contains("stability/method")) table.method = file.text("stability/method");
  table.error = read_if(file, "stability/error").value_or(0.0);
  table.branches = read_branches(file, table.values.size(), std::ssize(table.families));
  return table;
}

void write_rotation_stability(Writer& file, const RotationStability& stability)
{
  write_fields(file, "rotation_stability", stability);
  if (stability.exponents.size() == 0) return;
  file.write("rotation_stability/harmonics", std::int64_t{stability.harmonics}, "1");
  file.write("rotation_stability/error", stability.error, "1/s");
}

RotationStability read_rotation_stability(const Reader& file)
{
  auto stability = read_fields<RotationStability>(file, "rotation_stability");
  if (stability.exponents.size() == 0) return stability;
  stability.harmonics = mbs_export::file_parts::read_count(file, "rotation_stability/harmonics");
  stability.error = file.real("rotation_stability/error");
  return stability;
}

void write_gradients(Writer& file, const Gradients& gradients)
{
  const auto write_if = [&](const char* name, const std::optional<double>& x, const char* unit) {
    if (x) file.write(name, *x, unit);
  };
  write_if("gradients/critical_speed", gradients.critical_speed, "rad/s");
  write_if("gradients/critical_frequency", gradients.critical_frequency_Hz, "Hz");
  write_if("gradients/speed", gradients.speed, "rad/s");
  const auto n = std::ssize(gradients.rows), m = std::ssize(gradients.motions);
  std::vector<std::string> keys, units;
  Eigen::VectorXd values(n), critical(n);
  Eigen::MatrixXd by_value(n, m);
  for (Index i = 0; i < n; ++i) {
    const GradientRow& row = gradients.rows[static_cast<std::size_t>(i)];
    keys.push_back(row.key);
    units.push_back(row.unit);
    values[i] = row.value;
    critical[i] = row.critical_speed.value_or(0.0);
    by_value.row(i) = row.growth;
  }
  file.write("gradients/keys", keys);
  file.write("gradients/units", units);
  file.write("gradients/values", values, "that of each row");
  if (gradients.critical_speed)
    file.write("gradients/critical_speed_by_value", critical, "rad/s over that of each row");
  if (m == 0) return;
  write_rows(file, "gradients", gradients.motions);
  file.write("gradients/growth_by_value", by_value, "1/s over that of each row");
}

Gradients read_gradients(const Reader& file)
{
  Gradients gradients{.critical_speed = read_if(file, "gradients/critical_speed"),
                      .critical_frequency_Hz = read_if(file, "gradients/critical_frequency"),
                      .speed = read_if(file, "gradients/speed"),
                      .motions = {},
                      .rows = {}};
  const std::vector<std::string> keys = file.texts("gradients/keys"),
                                 units = file.texts("gradients/units");
  const auto n = std::ssize(keys);
  if (std::ssize(units) != n) file.fail("gradients/units", "are not as many as the keys");
  const Eigen::VectorXd values = file.vector("gradients/values", n);
  Eigen::VectorXd critical;
  Eigen::MatrixXd by_value(n, 0);
  if (gradients.critical_speed) critical = file.vector("gradients/critical_speed_by_value", n);
  if (file.contains("gradients/growth")) {
    gradients.motions = read_rows<GradientMotion>(file, "gradients");
    by_value = file.matrix("gradients/growth_by_value", {n, std::ssize(gradients.motions)});
  }
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    gradients.rows.push_back(
        {.key = keys[at],
         .unit = units[at],
         .value = values[i],
         .critical_speed = critical.size() > 0 ? std::optional(critical[i]) : std::nullopt,
         .growth = by_value.row(i)});
  }
  return gradients;
}

// Transients and limit cycles.

constexpr auto whole = "every sample", band_limited = "band-limited";

/// For whoever looks at the file alone, in words too.
void write_band(Writer& file, const Band& band)
{
  const bool is_whole = band.sampling == Sampling::whole;
  file.write("transient/history/sampling", is_whole ? whole : band_limited);
  file.write("transient/history/rate", band.rate_Hz, "Hz");
  file.write("transient/history/band", band.to_Hz, "Hz");
  file.attribute("transient/history", "sampling", spoken(band));
}

Band read_band(const Reader& file)
{
  if (!file.contains("transient/history/sampling")) return {};
  const std::string sampling = file.text("transient/history/sampling");
  if (sampling != whole && sampling != band_limited) {
    file.fail("transient/history/sampling",
              fmt::format("is \"{}\"; expected \"{}\" or \"{}\"", sampling, whole, band_limited));
  }
  return {sampling == whole ? Sampling::whole : Sampling::band_limited,
          file.real("transient/history/rate"), file.real("transient/history/band")};
}

Transient read_transient(const Reader& file)
{
  auto run = read_fields<Transient>(file, "transient");
  if (!std::ranges::is_sorted(run.events, {}, &ContactEvent::t))
    file.fail("transient/events/t", "expected times in ascending order");
  if (!file.contains("transient/events/count")) run.n_events = std::ssize(run.events);
  run.band = read_band(file);
  return run;
}

LimitCycle read_limit_cycle(const Reader& file)
{
  auto cycle = read_fields<LimitCycle>(file, "limit_cycle");
  if (cycle.amplitude.size() != 0 && cycle.amplitude.size() != std::ssize(cycle.mode_numbers))
    file.fail("limit_cycle/amplitude_re", "it must have one value for each mode");
  return cycle;
}

void write_branch(Writer& file, const LimitCycleBranch& branch)
{
  write_fields(file, "limit_cycle_branch", branch);
  if (branch.second_part) {
    file.write("limit_cycle_branch/second_part", static_cast<std::int64_t>(*branch.second_part),
               "1");
  }
  if (!branch.origin) return;
  file.write("limit_cycle_branch/origin/speed", branch.origin->speed, "rad/s");
  file.write("limit_cycle_branch/origin/frequency", branch.origin->frequency_Hz, "Hz");
  write_rows(file, "limit_cycle_branch/origin/first", std::vector{branch.origin->first});
}

LimitCycleBranch read_branch(const Reader& file)
{
  auto branch = read_fields<LimitCycleBranch>(file, "limit_cycle_branch");
  if (const std::string name = "limit_cycle_branch/second_part"; file.contains(name)) {
    const std::int64_t first = file.integer(name);
    if (first < 0 || first >= std::ssize(branch.points))
      file.fail(name, fmt::format("there is no point {} among {}", first, branch.points.size()));
    branch.second_part = static_cast<std::size_t>(first);
  }
  if (!file.contains("limit_cycle_branch/origin")) return branch;
  const auto first = read_rows<BranchPoint>(file, "limit_cycle_branch/origin/first");
  if (first.size() != 1) file.fail("limit_cycle_branch/origin/first/speeds", "expected one cycle");
  branch.origin = BranchOrigin{file.real("limit_cycle_branch/origin/speed"),
                               file.real("limit_cycle_branch/origin/frequency"), first.front()};
  return branch;
}

template <files::Stored T>
void write_if_any(Writer& file, const std::string& group, const std::optional<T>& x)
{
  if (x) write_fields(file, group, *x);
}

template <files::Stored T>
void read_if_any(const Reader& file, const std::string& group, std::optional<T>& x)
{
  if (file.contains(group)) x = read_fields<T>(file, group);
}

void write_stability(Writer& file, const SquealResults& results)
{
  if (results.eigenvalues) write_eigenvalues(file, "eigenvalues", *results.eigenvalues);
  if (results.frozen_eigenvalues)
    write_eigenvalues(file, "frozen_eigenvalues", *results.frozen_eigenvalues);
  if (results.searched_critical_speed) {
    file.group("critical");
    if (results.speed_stability) write_profile(file, "critical", *results.speed_stability, "rad/s");
    write_if_any(file, "critical", results.critical_speed);
  }
  write_critical_values(file, results.critical_values);
  if (results.stability_table) write_stability_table(file, *results.stability_table);
  if (results.map)
    write_fields(file, "stability_map", *results.map, unit_of(results.map->parameter));
  if (results.rotation_stability) write_rotation_stability(file, *results.rotation_stability);
  write_if_any(file, "mode_sensitivity", results.mode_sensitivity);
  if (results.gradients) write_gradients(file, *results.gradients);
}

void write_motions(Writer& file, const SquealResults& results)
{
  for (std::size_t i = 0; i < results.growth.size(); ++i)
    write_fields(file, fmt::format("growth/{}", i + 1), results.growth[i]);
  if (results.transient) {
    write_fields(file, "transient", *results.transient);
    write_band(file, results.transient->band);
  }
  write_if_any(file, "limit_cycle", results.limit_cycle);
  if (results.limit_cycle_direct) {
    const bool is_stable = stability_of(*results.limit_cycle_direct) == CycleStability::stable;
    write_fields(file, "limit_cycle_direct", *results.limit_cycle_direct);
    file.write("limit_cycle_direct/stable", std::int64_t{is_stable}, "1");
  }
  if (results.limit_cycle_branch) write_branch(file, *results.limit_cycle_branch);
  write_if_any(file, "spectrum", results.spectrum);
  write_if_any(file, "spectrogram", results.spectrogram);
  write_if_any(file, "motion_statistics", results.motion_statistics);
}

}  // namespace

void write_results(const std::filesystem::path& path, const SquealResults& results,
                   const mbs_export::Provenance& provenance)
{
  Writer file(path.string());
  file.attribute("/", "format", results_format);
  file.attribute("/", "version", results_version);
  mbs_export::file_parts::write_provenance(file, provenance);
  if (results.largest_split) file.write("largest_split", *results.largest_split, "1");
  if (results.wheel_radius) file.write("wheel_radius", *results.wheel_radius, "m");
  write_stability(file, results);
  write_motions(file, results);
  if (results.failure) file.write("failure", *results.failure);
  if (!results.missing.empty()) file.write("missing", results.missing);
  if (!results.inputs.empty()) file.write("inputs", results.inputs);
  file.commit();
}

SquealResults read_results(const std::filesystem::path& path)
{
  return read_results(Reader(path.string()));
}

SquealResults read_results(const Reader& file)
{
  file.expect_format(results_format, results_version);
  SquealResults results;
  results.largest_split = read_if(file, "largest_split");
  results.wheel_radius = read_if(file, "wheel_radius");
  if (file.contains("eigenvalues")) results.eigenvalues = read_eigenvalues(file, "eigenvalues");
  if (file.contains("frozen_eigenvalues"))
    results.frozen_eigenvalues = read_eigenvalues(file, "frozen_eigenvalues");
  results.searched_critical_speed = file.contains("critical");
  results.speed_stability = read_profile(file, "critical");
  if (file.contains("critical/speed"))
    results.critical_speed = read_fields<CriticalSpeed>(file, "critical");
  results.critical_values = read_critical_values(file);
  if (file.contains("stability")) results.stability_table = read_stability_table(file);
  read_if_any(file, "stability_map", results.map);
  if (file.contains("rotation_stability"))
    results.rotation_stability = read_rotation_stability(file);
  read_if_any(file, "mode_sensitivity", results.mode_sensitivity);
  if (file.contains("gradients")) results.gradients = read_gradients(file);
  for (int i = 1; file.contains(fmt::format("growth/{}", i)); ++i)
    results.growth.push_back(read_fields<Growth>(file, fmt::format("growth/{}", i)));
  if (file.contains("transient")) results.transient = read_transient(file);
  if (file.contains("limit_cycle")) results.limit_cycle = read_limit_cycle(file);
  read_if_any(file, "limit_cycle_direct", results.limit_cycle_direct);
  if (file.contains("limit_cycle_branch")) results.limit_cycle_branch = read_branch(file);
  read_if_any(file, "spectrum", results.spectrum);
  read_if_any(file, "spectrogram", results.spectrogram);
  read_if_any(file, "motion_statistics", results.motion_statistics);
  if (file.contains("failure")) results.failure = file.text("failure");
  if (file.contains("missing")) results.missing = file.texts("missing");
  if (file.contains("inputs")) results.inputs = file.text("inputs");
  return results;
}

}  // namespace chladni::squeal
