#include "squeal/motion/speed_program.hpp"

#include <algorithm>

namespace chladni::squeal {

Turn turn_at(const TransientCase& run, double t)
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

}  // namespace chladni::squeal
