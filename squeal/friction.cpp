#include "squeal/friction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

namespace chladni::squeal {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The slope at a point between two others: the weighted harmonic mean of the slopes on both sides,
/// 0 at a maximum or minimum.
double limited_slope(double h_0, double h_1, double s_0, double s_1)
{
  if (!(s_0 * s_1 > 0.0)) return 0.0;
  const double a = (h_0 + 2.0 * h_1) / (3.0 * (h_0 + h_1));
  return s_0 * s_1 / (a * s_1 + (1.0 - a) * s_0);
}

/// At an end: that of the parabola through three points, without overshoot.
double end_slope(double h_0, double h_1, double s_0, double s_1)
{
  const double slope = ((2.0 * h_0 + h_1) * s_0 - h_0 * s_1) / (h_0 + h_1);
  if (!(slope * s_0 > 0.0)) return 0.0;
  return s_0 * s_1 < 0.0 && std::abs(slope) > 3.0 * std::abs(s_0) ? 3.0 * s_0 : slope;
}

/// A value and its derivative.
struct Value {
  double y, slope;
};

/// The cubic over a distance `h` at the part s of it.
Value hermite(double h, double s, const Value& from, const Value& to)
{
  const double r = 1.0 - s, chord = to.y - from.y;
  const double y =
      from.y + chord * s * s * (3.0 - 2.0 * s) + h * s * r * (from.slope * r - to.slope * s);
  const double slope =
      6.0 * s * r * chord / h + from.slope * r * (1.0 - 3.0 * s) + to.slope * s * (3.0 * s - 2.0);
  return {y, slope};
}

/// The part [i, i + 1] of ascending numbers in which x lies.
std::size_t part_of(const std::vector<double>& at, double x)
{
  const auto above = std::ranges::upper_bound(at, x) - at.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(at) - 2));
}

bool is_beyond(const std::vector<double>& at, double x)
{
  return x < at.front() || x > at.back();
}

Value value_at(const FrictionCurve& curve, double v)
{
  const std::vector<double>& at = curve.speeds;
  if (at.size() == 1) return {curve.mu.front(), 0.0};
  if (is_beyond(at, v)) return {v < at.front() ? curve.mu.front() : curve.mu.back(), 0.0};
  const std::size_t i = part_of(at, v);
  const double h = at[i + 1] - at[i];
  return hermite(h, (v - at[i]) / h, {curve.mu[i], curve.slopes[i]},
                 {curve.mu[i + 1], curve.slopes[i + 1]});
}

/// d/dp at pressure i of what the curves have there: of the parabola through it and its neighbours,
/// at an end the slope to the next one. Linear in the values.
double slope_at(const std::vector<double>& p, std::size_t i, const auto& value)
{
  const auto chord = [&](std::size_t k) { return (value(k + 1) - value(k)) / (p[k + 1] - p[k]); };
  if (i == 0) return chord(0);
  if (i + 1 == p.size()) return chord(i - 1);
  const double h_0 = p[i] - p[i - 1], h_1 = p[i + 1] - p[i];
  return (h_1 * chord(i - 1) + h_0 * chord(i)) / (h_0 + h_1);
}

/// At one of the temperatures.
FrictionValue at_temperature(const FrictionTable& table, std::size_t t, const FrictionPlace& place)
{
  const std::vector<double>& p = table.pressures;
  const std::size_t n = std::max<std::size_t>(1, p.size());
  const auto of = [&](std::size_t k) { return value_at(table.curves[t * n + k], place.speed); };
  if (n == 1 || is_beyond(p, place.pressure)) {
    const Value end = of(n > 1 && place.pressure > p.back() ? n - 1 : 0);
    return {end.y, end.slope, 0.0};
  }
  const std::size_t i = part_of(p, place.pressure);
  const double h = p[i + 1] - p[i], s = (place.pressure - p[i]) / h;
  const auto mu = [&](std::size_t k) { return of(k).y; };
  const auto mu_v = [&](std::size_t k) { return of(k).slope; };
  const Value value =
      hermite(h, s, {mu(i), slope_at(p, i, mu)}, {mu(i + 1), slope_at(p, i + 1, mu)});
  const Value by_speed =
      hermite(h, s, {mu_v(i), slope_at(p, i, mu_v)}, {mu_v(i + 1), slope_at(p, i + 1, mu_v)});
  return {value.y, by_speed.y, value.slope};
}

}  // namespace

FrictionCurve friction_curve(std::vector<double> speeds, std::vector<double> mu)
{
  const std::size_t n = speeds.size();
  FrictionCurve curve{
      .speeds = std::move(speeds), .mu = std::move(mu), .slopes = std::vector<double>(n, 0.0)};
  if (n < 2) return curve;
  std::vector<double> h, s;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h.push_back(curve.speeds[i + 1] - curve.speeds[i]);
    s.push_back((curve.mu[i + 1] - curve.mu[i]) / h.back());
  }
  if (n == 2) {
    curve.slopes = {s[0], s[0]};
    return curve;
  }
  for (std::size_t i = 1; i + 1 < n; ++i)
    curve.slopes[i] = limited_slope(h[i - 1], h[i], s[i - 1], s[i]);
  curve.slopes.front() = end_slope(h[0], h[1], s[0], s[1]);
  curve.slopes.back() = end_slope(h[n - 2], h[n - 3], s[n - 2], s[n - 3]);
  return curve;
}

FrictionRange range_of(const FrictionTable& table)
{
  FrictionRange range{0.0, infinity, 0.0, infinity, -infinity, infinity};
  for (const FrictionCurve& curve : table.curves) {
    if (curve.speeds.size() == 1) continue;
    range.speed_from = std::max(range.speed_from, curve.speeds.front());
    range.speed_to = std::min(range.speed_to, curve.speeds.back());
  }
  if (table.pressures.size() > 1) {
    range.pressure_from = table.pressures.front();
    range.pressure_to = table.pressures.back();
  }
  if (!table.temperatures.empty()) {
    range.temperature_from = table.temperatures.front();
    range.temperature_to = table.temperatures.back();
  }
  return range;
}

FrictionValue friction_at(const FrictionTable& table, double temperature,
                          const FrictionPlace& place)
{
  const std::vector<double>& T = table.temperatures;
  if (T.size() < 2) return at_temperature(table, 0, place);
  const std::size_t i = part_of(T, temperature);
  const double s = std::clamp((temperature - T[i]) / (T[i + 1] - T[i]), 0.0, 1.0);
  const FrictionValue a = at_temperature(table, i, place), b = at_temperature(table, i + 1, place);
  const auto between = [s](double x, double y) { return (1.0 - s) * x + s * y; };
  return {between(a.mu, b.mu), between(a.by_speed, b.by_speed),
          between(a.by_pressure, b.by_pressure)};
}

}  // namespace chladni::squeal
