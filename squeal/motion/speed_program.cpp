#include "squeal/motion/speed_program.hpp"

#include <algorithm>

namespace chladni::squeal {

double preload_at(const TransientCase& run, double t)
{
  const std::vector<PreloadPoint>& points = run.preload_program;
  if (points.empty()) return 1.0;
  const auto next = std::ranges::upper_bound(points, t, {}, &PreloadPoint::time);
  if (next == points.begin()) return points.front().factor;
  if (next == points.end()) return points.back().factor;
  const PreloadPoint& last = *(next - 1);
  const double s = (t - last.time) / (next->time - last.time);
  return (1.0 - s) * last.factor + s * next->factor;
}

namespace {

Turn rotation_at(const TransientCase& run, double t)
{
  if (run.speed_program.empty()) return {.angle = run.speed * t, .speed = run.speed};
  SpeedPoint last{.time = 0.0, .speed = run.speed_program.front().speed};
  double angle = 0.0;
  for (const SpeedPoint& next : run.speed_program) {
    if (next.time <= last.time) continue;
    const double slope = (next.speed - last.speed) / (next.time - last.time);
    const double time = std::min(t, next.time) - last.time;
    angle += (last.speed + 0.5 * slope * time) * time;
    if (t <= next.time) return {.angle = angle, .speed = last.speed + slope * time};
    last = next;
  }
  return {.angle = angle + last.speed * (t - last.time), .speed = last.speed};
}

}  // namespace

Turn turn_at(const TransientCase& run, double t)
{
  Turn turn = rotation_at(run, t);
  turn.preload = preload_at(run, t);
  return turn;
}

}  // namespace chladni::squeal
