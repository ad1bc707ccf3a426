#include "squeal/results/limit_cycle_results.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

using files::Reader, files::Writer;

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

namespace {

Eigen::VectorXcd complex_vector(const Eigen::VectorXd& re, const Eigen::VectorXd& im)
{
  return re + std::complex<double>(0.0, 1.0) * im;
}

/// A dataset of a branch and the member that it holds.
struct Column {
  const char* name;
  const char* unit;
  double BranchPoint::*member;
};

constexpr Column columns[] = {{"speeds", "rad/s", &BranchPoint::speed},
                              {"frequency", "Hz", &BranchPoint::frequency_Hz},
                              {"pad_velocity", "m/s", &BranchPoint::pad_velocity},
                              {"pad_displacement", "m", &BranchPoint::pad_displacement},
                              {"N_min", "N", &BranchPoint::N_min},
                              {"N_max", "N", &BranchPoint::N_max},
                              {"largest_multiplier", "1", &BranchPoint::largest_multiplier}};

/// -1 stands for what is unknown.
void write_multiplier_errors(Writer& file, const std::string& name,
                             const std::vector<BranchPoint>& points)
{
  std::vector<double> errors;
  for (const BranchPoint& point : points) errors.push_back(point.multiplier_error.value_or(-1.0));
  file.write(name, errors, "1");
}

/// Files of earlier versions have none.
void read_multiplier_errors(const Reader& file, const std::string& name,
                            std::vector<BranchPoint>& points)
{
  if (!file.contains(name)) return;
  const Eigen::VectorXd errors = file.vector(name, std::ssize(points));
  for (Eigen::Index i = 0; i < errors.size(); ++i)
    if (errors[i] >= 0.0) points[static_cast<std::size_t>(i)].multiplier_error = errors[i];
}

void write_points(Writer& file, const std::string& group, const std::vector<BranchPoint>& points)
{
  for (const Column& column : columns) {
    std::vector<double> values;
    for (const BranchPoint& point : points) values.push_back(point.*column.member);
    file.write(group + column.name, values, column.unit);
  }
  write_multiplier_errors(file, group + "multiplier_error", points);
}

std::vector<BranchPoint> read_points(const Reader& file, const std::string& group)
{
  const Eigen::Index n = file.vector(group + columns[0].name).size();
  std::vector<BranchPoint> points(static_cast<std::size_t>(n));
  for (const Column& column : columns) {
    const Eigen::VectorXd values = file.vector(group + column.name, n);
    for (Eigen::Index i = 0; i < n; ++i)
      points[static_cast<std::size_t>(i)].*column.member = values[i];
  }
  read_multiplier_errors(file, group + "multiplier_error", points);
  return points;
}

/// A number with an error, as its group in the file.
struct Told {
  const char* name;
  const char* unit;
  ErrorBudget CycleErrors::*budget;
};

constexpr Told told_with_errors[] = {{"frequency", "Hz", &CycleErrors::frequency_Hz},
                                     {"pad_velocity", "m/s", &CycleErrors::pad_velocity},
                                     {"pad_displacement", "m", &CycleErrors::pad_displacement}};

std::string error_path(const Told& number, const char* part)
{
  return fmt::format("limit_cycle_direct/errors/{}/{}", number.name, part);
}

void write_cycle_errors(Writer& file, const CycleErrors& errors)
{
  for (const Told& number : told_with_errors)
    for (const auto& [name, part] : budget_parts)
      write_optional(file, error_path(number, name), (errors.*number.budget).*part, number.unit);
}

CycleErrors read_cycle_errors(const Reader& file)
{
  CycleErrors errors;
  for (const Told& number : told_with_errors)
    for (const auto& [name, part] : budget_parts)
      (errors.*number.budget).*part = read_optional(file, error_path(number, name));
  return errors;
}

std::optional<std::size_t> read_second_part(const Reader& file, std::size_t n_points)
{
  const std::string name = "limit_cycle_branch/second_part";
  if (!file.contains(name)) return std::nullopt;
  const std::int64_t first = file.integer(name);
  if (first < 0 || static_cast<std::size_t>(first) >= n_points)
    file.fail(name, fmt::format("there is no point {} among {}", first, n_points));
  return static_cast<std::size_t>(first);
}

}  // namespace

void write_direct(Writer& file, const DirectLimitCycle& cycle)
{
  file.write("limit_cycle_direct/speed", cycle.speed, "rad/s");
  file.write("limit_cycle_direct/frequency", cycle.frequency_Hz, "Hz");
  file.write("limit_cycle_direct/pad_velocity", cycle.pad_velocity, "m/s");
  file.write("limit_cycle_direct/pad_displacement", cycle.pad_displacement, "m");
  file.write("limit_cycle_direct/N_min", cycle.N_min, "N");
  file.write("limit_cycle_direct/N_max", cycle.N_max, "N");
  file.write("limit_cycle_direct/slip_speed_min", cycle.slip_speed_min, "m/s");
  file.write("limit_cycle_direct/multipliers_re", cycle.multipliers.real(), "1");
  file.write("limit_cycle_direct/multipliers_im", cycle.multipliers.imag(), "1");
  const bool is_stable = stability_of(cycle) == CycleStability::stable;
  file.write("limit_cycle_direct/stable", std::int64_t{is_stable}, "1");
  write_optional(file, "limit_cycle_direct/multiplier_error", cycle.multiplier_error, "1");
  file.write("limit_cycle_direct/newton_steps", std::int64_t{cycle.n_newton_steps}, "1");
  file.write("limit_cycle_direct/contact_evaluations", cycle.n_contact_evaluations, "1");
  file.write("limit_cycle_direct/x", cycle.x, "m kg^(1/2) / s");
  file.write("limit_cycle_direct/mode_numbers", std::span<const int>(cycle.mode_numbers), "1");
  file.write("limit_cycle_direct/amplitude_re", cycle.amplitude.real(), "m kg^(1/2)");
  file.write("limit_cycle_direct/amplitude_im", cycle.amplitude.imag(), "m kg^(1/2)");
  write_energy(file, cycle.energy);
  write_cycle_errors(file, cycle.errors);
  if (!cycle.way.empty()) file.write("limit_cycle_direct/way", cycle.way);
}

DirectLimitCycle read_direct(const Reader& file)
{
  std::vector<int> numbers = read_mode_numbers(file, "limit_cycle_direct/mode_numbers");
  const auto n = static_cast<Eigen::Index>(numbers.size());
  Eigen::VectorXd x = file.vector("limit_cycle_direct/x");
  const Eigen::Index size = x.size();
  if (size < 2)
    file.fail("limit_cycle_direct/x", "expected a displacement and a velocity at least");
  return {
      .speed = file.real("limit_cycle_direct/speed"),
      .frequency_Hz = file.real("limit_cycle_direct/frequency"),
      .pad_velocity = file.real("limit_cycle_direct/pad_velocity"),
      .pad_displacement = file.real("limit_cycle_direct/pad_displacement"),
      .N_min = file.real("limit_cycle_direct/N_min"),
      .N_max = file.real("limit_cycle_direct/N_max"),
      .slip_speed_min = file.real("limit_cycle_direct/slip_speed_min"),
      .multipliers = complex_vector(file.vector("limit_cycle_direct/multipliers_re", size),
                                    file.vector("limit_cycle_direct/multipliers_im", size)),
      .multiplier_error = read_optional(file, "limit_cycle_direct/multiplier_error"),
      .n_newton_steps = mbs_export::file_parts::read_count(file, "limit_cycle_direct/newton_steps"),
      .n_contact_evaluations = file.integer("limit_cycle_direct/contact_evaluations"),
      .x = std::move(x),
      .mode_numbers = std::move(numbers),
      .amplitude = complex_vector(file.vector("limit_cycle_direct/amplitude_re", n),
                                  file.vector("limit_cycle_direct/amplitude_im", n)),
      .energy = read_energy(file),
      .way = file.contains("limit_cycle_direct/way") ? file.text("limit_cycle_direct/way") : "",
      .errors = read_cycle_errors(file)};
}

void write_branch(Writer& file, const LimitCycleBranch& branch)
{
  write_points(file, "limit_cycle_branch/", branch.points);
  if (!branch.folds.empty()) write_points(file, "limit_cycle_branch/folds/", branch.folds);
  write_optional(file, "limit_cycle_branch/lost_below", branch.lost_below, "rad/s");
  write_optional(file, "limit_cycle_branch/lost_above", branch.lost_above, "rad/s");
  if (!branch.note.empty()) file.write("limit_cycle_branch/note", branch.note);
  if (branch.second_part) {
    file.write("limit_cycle_branch/second_part", static_cast<std::int64_t>(*branch.second_part),
               "1");
  }
  if (!branch.origin) return;
  file.write("limit_cycle_branch/origin/speed", branch.origin->speed, "rad/s");
  file.write("limit_cycle_branch/origin/frequency", branch.origin->frequency_Hz, "Hz");
  write_points(file, "limit_cycle_branch/origin/first/", {branch.origin->first});
}

LimitCycleBranch read_branch(const Reader& file)
{
  LimitCycleBranch branch;
  branch.points = read_points(file, "limit_cycle_branch/");
  if (file.contains("limit_cycle_branch/folds"))
    branch.folds = read_points(file, "limit_cycle_branch/folds/");
  branch.lost_below = read_optional(file, "limit_cycle_branch/lost_below");
  branch.lost_above = read_optional(file, "limit_cycle_branch/lost_above");
  if (file.contains("limit_cycle_branch/note")) branch.note = file.text("limit_cycle_branch/note");
  branch.second_part = read_second_part(file, branch.points.size());
  if (!file.contains("limit_cycle_branch/origin")) return branch;
  const auto first = read_points(file, "limit_cycle_branch/origin/first/");
  if (first.size() != 1) file.fail("limit_cycle_branch/origin/first/speeds", "expected one cycle");
  branch.origin = BranchOrigin{file.real("limit_cycle_branch/origin/speed"),
                               file.real("limit_cycle_branch/origin/frequency"), first.front()};
  return branch;
}

}  // namespace chladni::squeal
