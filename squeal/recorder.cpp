#include "squeal/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace chladni::squeal {

void PeakFinder::add(double t, double x, double step)
{
  const double now = x, sign = last_ < 0.0 ? -1.0 : 1.0;
  const double y_0 = sign * before_, y_1 = sign * last_, y_2 = sign * now;
  if (++n_seen_ > 2 && y_1 > y_0 && y_1 >= y_2) {
    // Vertex of the parabola through the three samples; curvature < 0 here.
    const double slope = 0.5 * (y_2 - y_0), curvature = y_2 - 2.0 * y_1 + y_0;
    const double value = y_1 - 0.5 * slope * slope / curvature;
    if (!largest_ || value > largest_->value)
      largest_ = Peak{t - step * (1.0 + slope / curvature), value};
  }
  before_ = last_;
  last_ = now;
}

std::optional<PeakFinder::Peak> PeakFinder::take()
{
  return std::exchange(largest_, std::nullopt);
}

Recorder::Recorder(const RecordingPlan& plan, double rest) : plan_(plan), rest_(rest)
{
  transient_.step = plan.step;
  transient_.N_min = std::numeric_limits<double>::infinity();
  transient_.N_max = -std::numeric_limits<double>::infinity();
  transient_.slip_speed_min = std::numeric_limits<double>::infinity();
}

void Recorder::add(std::int64_t i, double t, const std::vector<ContactResult<double>>& contacts)
{
  for (const ContactResult<double>& contact : contacts) {
    add_extremes(t, contact.upper);
    add_extremes(t, contact.lower);
  }
  const PadState<double>&up = contacts.front().upper, &lo = contacts.front().lower;
  velocity_.add(t, up.z_dot, plan_.step);
  displacement_.add(t, up.z - rest_, plan_.step);
  if ((i + 1) % plan_.window == 0) close_window();

  const auto append = [&](History& history) {
    history.t.push_back(t);
    history.pad_velocity.push_back(up.z_dot);
    history.pad_displacement.push_back(up.z - rest_);
    history.N_up.push_back(up.N);
    history.N_lo.push_back(lo.N);
    history.slip_speed.push_back(up.slip_speed);
  };
  if (i % plan_.every == 0) append(transient_.history);
  if (in_tail(i)) append(transient_.tail);
}

void Recorder::add_extremes(double t, const PadState<double>& pad)
{
  transient_.N_min = std::min(transient_.N_min, pad.N);
  transient_.N_max = std::max(transient_.N_max, pad.N);
  transient_.slip_speed_min = std::min(transient_.slip_speed_min, pad.slip_speed);
  if (!transient_.t_zero_force && pad.N <= 0.0) transient_.t_zero_force = t;
}

void Recorder::close_window()
{
  const auto velocity = velocity_.take(), displacement = displacement_.take();
  if (!velocity || !displacement) return;
  transient_.envelope.t.push_back(velocity->t);
  transient_.envelope.pad_velocity.push_back(velocity->value);
  transient_.envelope.pad_displacement.push_back(displacement->value);
}

}  // namespace chladni::squeal
