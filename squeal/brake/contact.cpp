#include "squeal/brake/contact.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "common/error.hpp"

namespace chladni::squeal {

namespace {

struct Bound {
  std::string_view what, unit;
  double value, from, to;
};

}  // namespace

void require_in_table(const PadContact& pad, double speed)
{
  const FrictionLaw& law = pad.friction;
  if (!law.table) return;
  const FrictionRange range = range_of(*law.table);
  const double p = pressure_of(pad, pad.preload);
  constexpr double same = 1e-12;
  for (const PadFace& face : pad.faces) {
    const double slip = std::abs(speed) * face.radius;
    const double v = regularised_speed(law, slip * slip);
    const std::array bounds{Bound{"sliding at", "m/s", v, range.speed_from, range.speed_to},
                            Bound{"a pressure of", "Pa", p, range.pressure_from, range.pressure_to},
                            Bound{"a temperature of", "degrees Celsius", law.temperature,
                                  range.temperature_from, range.temperature_to}};
    for (const Bound& bound : bounds) {
      const double margin = same * std::abs(bound.value);
      if (bound.value >= bound.from - margin && bound.value <= bound.to + margin) continue;
      throw Error(fmt::format(
          "[squeal] friction.table: {} {:.6g} {} (rotation {:.6g} rad/s, preload {:.6g} "
          "N at a point) is outside its range, {:.6g} to {:.6g} {}; extend the table, or "
          "keep speed and preload within it",
          bound.what, bound.value, bound.unit, speed, pad.preload, bound.from, bound.to,
          bound.unit));
    }
  }
}

}  // namespace chladni::squeal
