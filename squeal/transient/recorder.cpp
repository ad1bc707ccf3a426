#include "squeal/transient/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "squeal/motion/splitting.hpp"

namespace chladni::squeal {

namespace {

/// Of a history: pad velocity and displacement, both normal forces, speed of sliding.
constexpr Eigen::Index n_signals = 5;

void append_sample(History& history, double t, const Eigen::VectorXd& x)
{
  history.t.push_back(t);
  history.pad_velocity.push_back(x[0]);
  history.pad_displacement.push_back(x[1]);
  history.N_up.push_back(x[2]);
  history.N_lo.push_back(x[3]);
  history.slip_speed.push_back(x[4]);
}

}  // namespace

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

Recorder::Recorder(const RecordingPlan& plan, double rest)
    : plan_(plan), rest_(rest), history_(plan.history, n_signals)
{
  transient_.step = plan.step;
  const double rate_Hz = 1.0 / (plan.step * double(plan.history.every()));
  const bool whole = plan.history.every() == 1;
  transient_.band = {whole ? Sampling::whole : Sampling::band_limited, rate_Hz,
                     (whole ? 0.5 : decimated_band) * rate_Hz};
  transient_.N_min = std::numeric_limits<double>::infinity();
  transient_.N_max = -std::numeric_limits<double>::infinity();
  transient_.slip_speed_min = std::numeric_limits<double>::infinity();
}

void Recorder::add(const Sample& sample)
{
  for (const ContactResult<double>& contact : sample.contacts) {
    add_extremes(sample.t, contact.upper);
    add_extremes(sample.t, contact.lower);
  }
  const PadState<double>&up = sample.contacts.front().upper, &lo = sample.contacts.front().lower;
  velocity_.add(sample.t, up.z_dot, plan_.step);
  displacement_.add(sample.t, up.z - rest_, plan_.step);
  add_to_window(sample);
  const auto n_windows = static_cast<std::int64_t>(transient_.windows.t.size());
  if (n_in_window_ == (n_windows <= plan_.n_fine_windows ? plan_.window : plan_.late_window))
    close_window();

  Eigen::VectorXd x(n_signals);
  x << up.z_dot, up.z - rest_, up.N, lo.N, up.slip_speed;
  if (!begin_) begin_ = sample.t;
  if (const auto kept = history_.add(x)) keep(*kept);
  if (in_tail(sample.i)) append_sample(transient_.tail, sample.t, x);
}

void Recorder::finish()
{
  for (const Eigen::VectorXd& rest : history_.finish()) keep(rest);
  if (n_in_window_ > 0) end_window();  // too short for a point of the envelope
}

/// The next sample of the history.
void Recorder::keep(const Eigen::VectorXd& sample)
{
  const double distance = plan_.step * double(plan_.history.every());
  append_sample(transient_.history, *begin_ + double(transient_.history.t.size()) * distance,
                sample);
}

void Recorder::add_extremes(double t, const PadState<double>& pad)
{
  transient_.N_min = std::min(transient_.N_min, pad.N);
  transient_.N_max = std::max(transient_.N_max, pad.N);
  transient_.slip_speed_min = std::min(transient_.slip_speed_min, pad.slip_speed);
  if (!transient_.t_zero_force && pad.N <= 0.0) transient_.t_zero_force = t;
}

void Recorder::add_to_window(const Sample& sample)
{
  Windows& windows = transient_.windows;
  const PadState<double>&up = sample.contacts.front().upper, &lo = sample.contacts.front().lower;
  if (n_in_window_++ == 0) {
    windows.t.push_back(sample.t);
    windows.speed.push_back(sample.speed);
    for (auto* N : {&windows.N_up_min, &windows.N_up_max}) N->push_back(up.N);
    for (auto* N : {&windows.N_lo_min, &windows.N_lo_max}) N->push_back(lo.N);
    windows.slip_speed_min.push_back(up.slip_speed);
  }
  const auto lower = [](std::vector<double>& x, double y) { x.back() = std::min(x.back(), y); };
  const auto raise = [](std::vector<double>& x, double y) { x.back() = std::max(x.back(), y); };
  lower(windows.N_up_min, up.N);
  raise(windows.N_up_max, up.N);
  lower(windows.N_lo_min, lo.N);
  raise(windows.N_lo_max, lo.N);
  lower(windows.slip_speed_min, up.slip_speed);
  if (up.N <= 0.0 || lo.N <= 0.0) ++n_open_;
}

void Recorder::end_window()
{
  transient_.windows.open.push_back(double(n_open_) / double(n_in_window_));
  n_in_window_ = n_open_ = 0;
}

void Recorder::close_window()
{
  end_window();
  const auto velocity = velocity_.take(), displacement = displacement_.take();
  if (!velocity || !displacement) return;
  transient_.envelope.t.push_back(velocity->t);
  transient_.envelope.pad_velocity.push_back(velocity->value);
  transient_.envelope.pad_displacement.push_back(displacement->value);
}

namespace {

/// q in the inertial frame but along the modes of the body.
Eigen::VectorXd in_inertial_frame(const InertialDisc& inertial, const Eigen::VectorXd& q,
                                  double angle)
{
  return inertial.R * turned(inertial, inertial.R.transpose() * q, angle);
}

}  // namespace

TailRecorder::TailRecorder(const Disc& disc, const std::optional<InertialDisc>& inertial,
                           const RecordingPlan& plan, const TransientCase& run)
    : inertial_(inertial), plan_(plan), run_(run)
{
  if (inertial) tail_a_.setZero(disc.n_modes(), static_cast<Eigen::Index>(plan.n_tail));
}

void TailRecorder::add(std::int64_t i, double t, const ModalSteps& steps)
{
  if (!inertial_ || i < plan_.n_steps - plan_.n_tail) return;
  tail_a_.col(n_tail_++) = in_inertial_frame(*inertial_, steps.state().q, turn_at(run_, t).angle);
}

}  // namespace chladni::squeal
