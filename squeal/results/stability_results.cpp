#include "squeal/results/stability_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/file_checks.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

using Eigen::Index;
using files::Reader, files::Writer;

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

/// One number of each point.
Eigen::VectorXd column(const std::vector<StabilityPoint>& points, double StabilityPoint::*of)
{
  Eigen::VectorXd x(std::ssize(points));
  for (std::size_t i = 0; i < points.size(); ++i) x[static_cast<Index>(i)] = points[i].*of;
  return x;
}

}  // namespace

void write_points(Writer& file, const std::string& group, const std::vector<StabilityPoint>& points,
                  const std::string& unit)
{
  file.write(group + "/values", column(points, &StabilityPoint::value), unit);
  file.write(group + "/growth", column(points, &StabilityPoint::growth), "1/s");
  file.write(group + "/frequency", column(points, &StabilityPoint::frequency_Hz), "Hz");
}

std::vector<StabilityPoint> read_points(const Reader& file, const std::string& group, Index n)
{
  const Eigen::VectorXd values = file.vector(group + "/values", n);
  const Eigen::VectorXd growth = file.vector(group + "/growth", n);
  const Eigen::VectorXd frequency_Hz = file.vector(group + "/frequency", n);
  std::vector<StabilityPoint> points;
  for (Index i = 0; i < n; ++i) points.push_back({values[i], growth[i], frequency_Hz[i]});
  return points;
}

void write_intervals(Writer& file, const std::string& group,
                     const std::vector<UnstableInterval>& intervals, const std::string& unit)
{
  if (intervals.empty()) return;
  std::vector<StabilityPoint> from, to, worst;
  for (const UnstableInterval& interval : intervals) {
    from.push_back(interval.from);
    to.push_back(interval.to);
    worst.push_back(interval.worst);
  }
  write_points(file, group + "/from", from, unit);
  write_points(file, group + "/to", to, unit);
  write_points(file, group + "/worst", worst, unit);
}

std::vector<UnstableInterval> read_intervals(const Reader& file, const std::string& group)
{
  std::vector<UnstableInterval> intervals;
  if (!file.contains(group + "/from/values")) return intervals;
  const Index n = file.vector(group + "/from/values").size();
  const auto from = read_points(file, group + "/from", n);
  const auto to = read_points(file, group + "/to", n);
  const auto worst = read_points(file, group + "/worst", n);
  for (std::size_t i = 0; i < from.size(); ++i) intervals.push_back({from[i], to[i], worst[i]});
  return intervals;
}

void write_profile(Writer& file, const std::string& group, const StabilityProfile& profile,
                   const std::string& unit)
{
  file.write(group + "/stability", std::string(name_of(stability_of(profile))));
  if (!profile.method.empty()) file.write(group + "/method", profile.method);
  write_points(file, group + "/range", {profile.from, profile.to}, unit);
  write_intervals(file, group + "/unstable", profile.unstable, unit);
}

std::optional<StabilityProfile> read_profile(const Reader& file, const std::string& group)
{
  if (!file.contains(group + "/range/values")) return std::nullopt;
  const std::vector<StabilityPoint> range = read_points(file, group + "/range", 2);
  return StabilityProfile{range[0], range[1], read_intervals(file, group + "/unstable"),
                          file.contains(group + "/method") ? file.text(group + "/method") : ""};
}

namespace {

/// -1 stands for what is unknown.
void write_figures(Writer& file, const std::vector<ModeFamily>& families)
{
  std::vector<std::int64_t> circles;
  std::vector<double> in_plane;
  for (const ModeFamily& family : families) {
    circles.push_back(family.nodal_circles.value_or(-1));
    in_plane.push_back(family.in_plane.value_or(-1.0));
  }
  file.write("stability/families/nodal_circles", std::span<const std::int64_t>(circles), "1");
  file.write("stability/families/in_plane", in_plane, "1");
}

void read_figures(const Reader& file, std::vector<ModeFamily>& families)
{
  if (!file.contains("stability/families/nodal_circles")) return;
  const auto circles = file.integers("stability/families/nodal_circles", std::ssize(families));
  const Eigen::VectorXd in_plane = file.vector("stability/families/in_plane", std::ssize(families));
  for (std::size_t i = 0; i < families.size(); ++i) {
    if (circles[i] >= 0) families[i].nodal_circles = static_cast<int>(circles[i]);
    const double share = in_plane[static_cast<Index>(i)];
    if (share >= 0.0) families[i].in_plane = share;
  }
}

void write_participation(Writer& file, const StabilityTable& table)
{
  if (table.families.empty()) return;
  const auto n = static_cast<Index>(table.families.size()), m = std::ssize(table.branches);
  std::vector<std::int64_t> diameters;
  Eigen::VectorXd frequency_Hz(n), pads(m);
  Eigen::MatrixXd shares(m, n);
  for (Index i = 0; i < n; ++i) {
    const ModeFamily& family = table.families[static_cast<std::size_t>(i)];
    diameters.push_back(family.nodal_diameters);
    frequency_Hz[i] = family.frequency_Hz;
  }
  for (Index j = 0; j < m; ++j) {
    shares.row(j) = table.branches[static_cast<std::size_t>(j)].shares.transpose();
    pads[j] = table.branches[static_cast<std::size_t>(j)].pads;
  }
  file.write("stability/families/nodal_diameters", std::span<const std::int64_t>(diameters), "1");
  file.write("stability/families/frequency", frequency_Hz, "Hz");
  write_figures(file, table.families);
  if (m == 0) return;
  file.write("stability/shares", shares, "1");
  file.write("stability/pads", pads, "1");
}

/// The works of those branches that have some, and which these are.
void write_works(Writer& file, const StabilityTable& table)
{
  std::vector<std::int64_t> of;
  std::vector<double> friction, normal, damping;
  for (std::size_t j = 0; j < table.branches.size(); ++j) {
    const auto& work = table.branches[j].work;
    if (!work) continue;
    of.push_back(static_cast<std::int64_t>(j) + 1);
    friction.push_back(work->friction);
    normal.push_back(work->normal);
    damping.push_back(work->damping);
  }
  if (of.empty()) return;
  file.write("stability/work/branch", std::span<const std::int64_t>(of), "1");
  file.write("stability/work/friction", friction, "1");
  file.write("stability/work/normal", normal, "1");
  file.write("stability/work/damping", damping, "1");
}

/// -1 stands for what is unknown.
void write_errors(Writer& file, const StabilityTable& table)
{
  for (const auto& [name, part] : budget_parts) {
    std::vector<double> errors;
    for (const StabilityBranch& branch : table.branches)
      errors.push_back((branch.budget.*part).value_or(-1.0));
    if (std::ranges::all_of(errors, [](double error) { return error < 0.0; })) continue;
    file.write(fmt::format("stability/errors/{}", name), errors, "1/s");
  }
}

void read_errors(const Reader& file, std::vector<StabilityBranch>& branches)
{
  for (const auto& [name, part] : budget_parts) {
    const std::string path = fmt::format("stability/errors/{}", name);
    if (!file.contains(path)) continue;
    const Eigen::VectorXd errors = file.vector(path, std::ssize(branches));
    for (Index j = 0; j < errors.size(); ++j)
      if (errors[j] >= 0.0) branches[static_cast<std::size_t>(j)].budget.*part = errors[j];
  }
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
  write_points(file, "stability/worst", worst, unit);
  if (unstable.empty()) return;
  write_intervals(file, "stability/unstable", unstable, unit);
  file.write("stability/unstable/branch", std::span<const std::int64_t>(of), "1");
}

std::vector<ModeFamily> read_families(const Reader& file)
{
  std::vector<ModeFamily> families;
  if (!file.contains("stability/families")) return families;
  const Eigen::VectorXd frequency_Hz = file.vector("stability/families/frequency");
  const auto diameters = file.integers("stability/families/nodal_diameters", frequency_Hz.size());
  for (std::size_t i = 0; i < diameters.size(); ++i)
    families.push_back({static_cast<int>(diameters[i]), frequency_Hz[static_cast<Index>(i)]});
  read_figures(file, families);
  return families;
}

void read_intervals_of_branches(const Reader& file, std::vector<StabilityBranch>& branches)
{
  const std::vector<UnstableInterval> unstable = read_intervals(file, "stability/unstable");
  if (unstable.empty()) return;
  const auto of = file.integers("stability/unstable/branch", std::ssize(unstable));
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (of[i] < 1 || of[i] > std::ssize(branches))
      file.fail("stability/unstable/branch", "it must number a row of stability/growth, from 1");
    branches[static_cast<std::size_t>(of[i] - 1)].unstable.push_back(unstable[i]);
  }
}

void read_works(const Reader& file, std::vector<StabilityBranch>& branches)
{
  if (!file.contains("stability/work")) return;
  const Eigen::VectorXd friction = file.vector("stability/work/friction");
  const Eigen::VectorXd normal = file.vector("stability/work/normal", friction.size());
  const Eigen::VectorXd damping = file.vector("stability/work/damping", friction.size());
  const auto of = file.integers("stability/work/branch", friction.size());
  for (Index i = 0; i < friction.size(); ++i) {
    const std::int64_t branch = of[static_cast<std::size_t>(i)];
    if (branch < 1 || branch > std::ssize(branches))
      file.fail("stability/work/branch", "it must number a row of stability/growth, from 1");
    branches[static_cast<std::size_t>(branch - 1)].work =
        PeriodWork{friction[i], normal[i], damping[i]};
  }
}

std::vector<StabilityBranch> read_branches(const Reader& file, Index n_values, Index n_families)
{
  std::vector<StabilityBranch> branches;
  if (!file.contains("stability/growth")) return branches;
  const Eigen::MatrixXd growth = file.matrix("stability/growth", {files::any, n_values});
  const Index m = growth.rows();
  const Eigen::MatrixXd omega = file.matrix("stability/angular_frequency", {m, n_values});
  const std::vector<StabilityPoint> worst = read_points(file, "stability/worst", m);
  const bool has_shares = n_families > 0;
  const Eigen::MatrixXd shares =
      has_shares ? file.matrix("stability/shares", {m, n_families}) : Eigen::MatrixXd(m, 0);
  const Eigen::VectorXd pads =
      has_shares ? file.vector("stability/pads", m) : Eigen::VectorXd(Eigen::VectorXd::Zero(m));
  const std::complex<double> i(0.0, 1.0);
  for (Index j = 0; j < m; ++j) {
    branches.push_back({.lambda = (growth.row(j) + i * omega.row(j)).transpose(),
                        .unstable = {},
                        .worst = worst[static_cast<std::size_t>(j)],
                        .shares = shares.row(j).transpose(),
                        .pads = pads[j]});
  }
  read_intervals_of_branches(file, branches);
  read_works(file, branches);
  read_errors(file, branches);
  return branches;
}

}  // namespace

void write_stability_table(Writer& file, const StabilityTable& table)
{
  const std::string unit = unit_of(table.parameter);
  file.write("stability/parameter", table.parameter);
  file.write("stability/values", table.values, unit);
  write_optional(file, "stability/speed", table.speed, "rad/s");
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

StabilityTable read_stability_table(const Reader& file)
{
  StabilityTable table{.parameter = file.text("stability/parameter"),
                       .speed = read_optional(file, "stability/speed"),
                       .band = {},
                       .values = read_some(file, "stability/values"),
                       .families = read_families(file),
                       .branches = {}};
  if (file.contains("stability/band")) {
    const Eigen::VectorXd band = file.vector("stability/band", 2);
    table.band = FrequencyBand{band[0], band[1]};
  }
  if (file.contains("stability/method")) table.method = file.text("stability/method");
  table.error = read_optional(file, "stability/error").value_or(0.0);
  table.branches = read_branches(file, table.values.size(), std::ssize(table.families));
  return table;
}

void write_rotation_stability(files::Writer& file, const RotationStability& stability)
{
  file.write("rotation_stability/speeds", stability.speeds, "rad/s");
  file.write("rotation_stability/growth", stability.growth, "1/s");
  file.write("rotation_stability/frequency", stability.frequency_Hz, "Hz");
  write_optional(file, "rotation_stability/critical_speed", stability.critical_speed, "rad/s");
  if (stability.frozen_growth.size() > 0)
    file.write("rotation_stability/frozen_growth", stability.frozen_growth, "1/s");
  if (stability.method.empty()) return;
  file.write("rotation_stability/method", stability.method);
  if (stability.exponents.size() == 0) return;
  file.write("rotation_stability/harmonics", std::int64_t{stability.harmonics}, "1");
  file.write("rotation_stability/error", stability.error, "1/s");
  file.write("rotation_stability/exponents_re", Eigen::MatrixXd(stability.exponents.real()), "1/s");
  file.write("rotation_stability/exponents_im", Eigen::MatrixXd(stability.exponents.imag()),
             "rad/s");
}

RotationStability read_rotation_stability(const files::Reader& file)
{
  const Eigen::VectorXd speeds = read_some(file, "rotation_stability/speeds");
  RotationStability stability{speeds, file.vector("rotation_stability/growth", speeds.size()),
                              file.vector("rotation_stability/frequency", speeds.size()),
                              read_optional(file, "rotation_stability/critical_speed")};
  if (file.contains("rotation_stability/frozen_growth"))
    stability.frozen_growth = file.vector("rotation_stability/frozen_growth", speeds.size());
  if (file.contains("rotation_stability/method"))
    stability.method = file.text("rotation_stability/method");
  if (!file.contains("rotation_stability/exponents_re")) return stability;
  stability.harmonics = mbs_export::file_parts::read_count(file, "rotation_stability/harmonics");
  stability.error = file.real("rotation_stability/error");
  const Eigen::MatrixXd re = file.matrix("rotation_stability/exponents_re");
  const Eigen::MatrixXd im = file.matrix("rotation_stability/exponents_im", {re.rows(), re.cols()});
  if (re.rows() != speeds.size())
    file.fail("rotation_stability/exponents_re", "it must have one row for each speed");
  stability.exponents = re + std::complex<double>(0.0, 1.0) * im;
  return stability;
}

}  // namespace chladni::squeal
