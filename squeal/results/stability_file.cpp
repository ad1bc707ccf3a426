#include "squeal/results/stability_file.hpp"

#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;
using files::Reader;
using files::Writer;

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

}  // namespace chladni::squeal
