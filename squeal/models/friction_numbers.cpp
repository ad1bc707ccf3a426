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

/// The distance to the nearer neighbour.
double nearest(const std::vector<double>& ascending, std::size_t i)
{
  double distance = std::numeric_limits<double>::infinity();
  if (i > 0) distance = ascending[i] - ascending[i - 1];
  if (i + 1 < ascending.size()) distance = std::min(distance, ascending[i + 1] - ascending[i]);
  return distance;
}

/// A number of a point of a curve.
struct PointNumber {
  std::string_view name, unit;
  std::vector<double> FrictionCurve::*values;
};

constexpr PointNumber mu_of_points{"mu", "1", &FrictionCurve::mu};
constexpr PointNumber speeds_of_points{"speed_m_s", "m/s", &FrictionCurve::speeds};

/// @param at    index of the curve in the table of the law
/// @param step  of differences, in the unit of the number
FrictionNumber number_of_point(const FrictionLaw& law, std::size_t at, std::size_t point,
                               const PointNumber& number, double step)
{
  const FrictionCurve& curve = law.table->curves[at];
  return {.key = fmt::format("{}[{}]", number.name, point + 1),
          .unit = number.unit,
          .value = (curve.*(number.values))[point],
          .step = step,
          .with = [law, at, point, values = number.values](double value) {
            FrictionCurve changed = law.table->curves[at];
            (changed.*values)[point] = value;
            return with_curve(law, at,
                              friction_curve(std::move(changed.speeds), std::move(changed.mu)));
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
    const auto add = [&](FrictionNumber number) {
      number.key = fmt::format("{}.{}", row, number.key);
      numbers.push_back(std::move(number));
    };
    for (std::size_t point = 0; point < curve.mu.size(); ++point) {
      constexpr double of_mu = 1e-6, of_distance = 1e-5;
      add(number_of_point(law, at, point, mu_of_points, of_mu));
      if (curve.speeds.size() > 1) {
        add(number_of_point(law, at, point, speeds_of_points,
                            of_distance * nearest(curve.speeds, point)));
      }
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
