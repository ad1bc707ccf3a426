#include "squeal/results/stability_file.hpp"

#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {
namespace {

using files::Reader;
using files::Writer;

/// Points as rows: value, growth, frequency.
using Points = Eigen::MatrixX3d;

Eigen::RowVector3d row_of(const StabilityPoint& point)
{
  return {point.value, point.growth, point.frequency_Hz};
}

StabilityPoint point_of(const Points& points, Eigen::Index i)
{
  return {points(i, 0), points(i, 1), points(i, 2)};
}

void write_points(Writer& file, const std::string& group, const Points& points,
                  const std::string& unit)
{
  file.write(group + "/values", points.col(0).eval(), unit);
  file.write(group + "/growth", points.col(1).eval(), "1/s");
  file.write(group + "/frequency", points.col(2).eval(), "Hz");
}

Points read_points(const Reader& file, const std::string& group, Eigen::Index n)
{
  Points points(n, 3);
  points.col(0) = file.vector(group + "/values", n);
  points.col(1) = file.vector(group + "/growth", n);
  points.col(2) = file.vector(group + "/frequency", n);
  return points;
}

}  // namespace

void write_profile(Writer& file, const std::string& group, const StabilityProfile& profile,
                   const std::string& unit)
{
  Points range(2, 3);
  range << row_of(profile.from), row_of(profile.to);
  file.write(group + "/stability", std::string(name_of(stability_of(profile))));
  write_points(file, group + "/range", range, unit);
  const auto n = static_cast<Eigen::Index>(profile.unstable.size());
  if (n == 0) return;
  Points from(n, 3), to(n, 3), worst(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const UnstableInterval& interval = profile.unstable[static_cast<std::size_t>(i)];
    from.row(i) = row_of(interval.from);
    to.row(i) = row_of(interval.to);
    worst.row(i) = row_of(interval.worst);
  }
  write_points(file, group + "/unstable/from", from, unit);
  write_points(file, group + "/unstable/to", to, unit);
  write_points(file, group + "/unstable/worst", worst, unit);
}

std::optional<StabilityProfile> read_profile(const Reader& file, const std::string& group)
{
  if (!file.contains(group + "/range/values")) return std::nullopt;
  const Points range = read_points(file, group + "/range", 2);
  StabilityProfile profile{point_of(range, 0), point_of(range, 1), {}};
  if (!file.contains(group + "/unstable/from/values")) return profile;
  const Eigen::Index n = file.vector(group + "/unstable/from/values").size();
  const Points from = read_points(file, group + "/unstable/from", n);
  const Points to = read_points(file, group + "/unstable/to", n);
  const Points worst = read_points(file, group + "/unstable/worst", n);
  for (Eigen::Index i = 0; i < n; ++i)
    profile.unstable.push_back({point_of(from, i), point_of(to, i), point_of(worst, i)});
  return profile;
}

}  // namespace chladni::squeal
