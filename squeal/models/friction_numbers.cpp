#include "squeal/models/friction_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "squeal/models/friction_parameters.hpp"

namespace chladni::squeal {
namespace {

struct KeyOfLaw {
  std::string_view name, unit;
};

constexpr std::array keys_of_law{KeyOfLaw{"", "1"},
                                 KeyOfLaw{"kinetic", "1"},
                                 KeyOfLaw{"static", "1"},
                                 KeyOfLaw{"decay_speed", "m/s"},
                                 KeyOfLaw{"regularisation", "m/s"},
                                 KeyOfLaw{"temperature_C", "degrees Celsius"},
                                 KeyOfLaw{"factor", "1"}};

/// The law with one curve of its table in place of another.
FrictionLaw with_curve(FrictionLaw law, std::size_t at, FrictionCurve curve)
{
  FrictionTable table = *law.table;
  curve.row = table.curves[at].row;
  table.curves[at] = std::move(curve);
  law.table = std::make_shared<const FrictionTable>(std::move(table));
  return law;
}

FrictionNumber mu_of_point(const FrictionLaw& law, std::size_t at, std::size_t point,
                           const std::string& row)
{
  const FrictionCurve& curve = law.table->curves[at];
  return {.key = fmt::format("{}.mu[{}]", row, point + 1),
          .unit = "1",
          .value = curve.mu[point],
          .step = 1e-6,
          .with = [law, at, point](double value) {
            const FrictionCurve& old = law.table->curves[at];
            std::vector<double> mu = old.mu;
            mu[point] = value;
            return with_curve(law, at, friction_curve(old.speeds, std::move(mu)));
          }};
}

/// The distance to the nearer neighbour.
double nearest(const std::vector<double>& ascending, std::size_t i)
{
  double distance = std::numeric_limits<double>::infinity();
  if (i > 0) distance = ascending[i] - ascending[i - 1];
  if (i + 1 < ascending.size()) distance = std::min(distance, ascending[i + 1] - ascending[i]);
  return distance;
}

FrictionNumber speed_of_point(const FrictionLaw& law, std::size_t at, std::size_t point,
                              const std::string& row)
{
  const FrictionCurve& curve = law.table->curves[at];
  return {.key = fmt::format("{}.speed_m_s[{}]", row, point + 1),
          .unit = "m/s",
          .value = curve.speeds[point],
          .step = 1e-5 * nearest(curve.speeds, point),
          .with = [law, at, point](double value) {
            const FrictionCurve& old = law.table->curves[at];
            std::vector<double> speeds = old.speeds;
            speeds[point] = value;
            return with_curve(law, at, friction_curve(std::move(speeds), old.mu));
          }};
}

}  // namespace

std::vector<FrictionNumber> friction_points(const FrictionLaw& law, const std::string& key)
{
  std::vector<FrictionNumber> numbers;
  if (!law.table) return numbers;
  for (std::size_t at = 0; at < law.table->curves.size(); ++at) {
    const FrictionCurve& curve = law.table->curves[at];
    const std::string row = fmt::format("{}.table[{}]", key, curve.row);
    for (std::size_t point = 0; point < curve.mu.size(); ++point) {
      numbers.push_back(mu_of_point(law, at, point, row));
      if (curve.speeds.size() > 1) numbers.push_back(speed_of_point(law, at, point, row));
    }
  }
  return numbers;
}

std::vector<FrictionNumber> friction_numbers(const FrictionLaw& law, const std::string& key)
{
  std::vector<FrictionNumber> numbers;
  for (const auto& [name, unit] : keys_of_law) {
    if (!is_said_by(law, name)) continue;
    numbers.push_back({.key = name.empty() ? key : fmt::format("{}.{}", key, name),
                       .unit = unit,
                       .value = *friction_value(law, name),
                       .step = 0.0,
                       .with = [law, name = name](double value) {
                         return with_friction_value(law, name, value);
                       }});
  }
  for (FrictionNumber& point : friction_points(law, key)) numbers.push_back(std::move(point));
  return numbers;
}

}  // namespace chladni::squeal
