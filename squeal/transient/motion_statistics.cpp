#include "squeal/transient/motion_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "common/error.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Fewest rotations: lines that are one rotation apart are four lines of their spectrum apart then,
/// as wide as those of the Hann window are.
constexpr int rotations_min = 4, rotations_max = 8;
/// Parts of a rotation.
constexpr int parts_of_rotation = 24;
/// Of the square of the velocity, that the history may lack.
constexpr double lacking_max = 0.02;
/// Least amplitude of a line beside that of the strongest.
constexpr double least_line = 1e-2;

/// The samples of the history in a span of time.
struct Samples {
  std::span<const double> velocity, displacement;
  double step;   ///< s
  double first;  ///< time of the first, s
};

/// From a time on.
std::size_t index_of(const std::vector<double>& t, double from)
{
  return static_cast<std::size_t>(std::ranges::lower_bound(t, from) - t.begin());
}

double mean_square(std::span<const double> x)
{
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return sum / double(x.size());
}

double rms_about_mean(std::span<const double> x)
{
  double mean = 0.0;
  for (const double value : x) mean += value / double(x.size());
  return std::sqrt(std::max(0.0, mean_square(x) - mean * mean));
}

int rotations_of(const Transient& run)
{
  const double half = 0.25 * run.speed * (run.history.t.back() - run.history.t.front()) / pi;
  const int n = std::min(2 * static_cast<int>(0.5 * half), rotations_max);
  if (n >= rotations_min) return n;
  throw Error(
      fmt::format("motion statistics: they take {} rotations and as much time before them; at {} "
                  "rad/s simulate at least {:.2g} s",
                  rotations_min, run.speed, 4.01 * rotations_min * pi / run.speed));
}

/// The history holds what the tail does, of which every sample is known.
void require_fine_history(const Transient& run)
{
  const double from = std::max(run.tail.t.front(), run.history.t.front());
  const std::span<const double> all(run.tail.pad_velocity);
  const std::span<const double> kept =
      std::span(run.history.pad_velocity).subspan(index_of(run.history.t, from));
  const double lacking = kept.empty() ? 1.0 : 1.0 - mean_square(kept) / mean_square(all);
  if (!(lacking > lacking_max)) return;
  throw Error(
      fmt::format("motion statistics: the history of this run holds frequencies up to {:.0f} Hz, "
                  "without {:.0f} % of the motion; shorten transient.duration_s",
                  run.band.to_Hz, 100.0 * lacking));
}

void require_constant_speed(const Transient& run, double from)
{
  for (std::size_t i = index_of(run.windows.t, from); i < run.windows.t.size(); ++i)
    if (std::abs(run.windows.speed[i] - run.speed) > 1e-9 * run.speed) {
      throw Error(
          fmt::format("motion statistics: the speed changes until {:.3g} s, within the last "
                      "rotations; let speed_program end at a constant speed",
                      run.windows.t[i]));
    }
}

Samples samples_from(const Transient& run, double from)
{
  const History& history = run.history;
  const std::size_t first = index_of(history.t, from);
  return {.velocity = std::span(history.pad_velocity).subspan(first),
          .displacement = std::span(history.pad_displacement).subspan(first),
          .step = 1.0 / run.band.rate_Hz,
          .first = history.t[first]};
}

Eigen::VectorXd rms_over_angle(const Samples& x, double speed)
{
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(parts_of_rotation), count = sum;
  for (std::size_t i = 0; i < x.velocity.size(); ++i) {
    const double rotations = speed * (x.first + double(i) * x.step) / (2.0 * pi);
    const auto part =
        std::min(parts_of_rotation - 1,
                 static_cast<int>(parts_of_rotation * (rotations - std::floor(rotations))));
    sum[part] += x.velocity[i] * x.velocity[i];
    count[part] += 1.0;
  }
  return (sum / count.max(1.0)).sqrt();
}

std::vector<MotionStatistics::Line> lines_of(const Samples& x, double speed)
{
  std::vector<MotionStatistics::Line> lines;
  const Spectrum found = spectrum(x.velocity, x.step);
  for (const Spectrum::Peak& peak : found.peaks) {
    if (peak.amplitude < least_line * found.peaks.front().amplitude) break;
    const double away = peak.frequency_Hz - found.peaks.front().frequency_Hz;
    lines.push_back({.frequency_Hz = peak.frequency_Hz,
                     .amplitude = peak.amplitude,
                     .rotations = 2.0 * pi * away / speed});
  }
  return lines;
}

/// Largest values, from windows of every sample.
void add_extremes(MotionStatistics& result, const Transient& run)
{
  const Envelope& peaks = run.envelope;
  for (std::size_t i = index_of(peaks.t, result.from); i < peaks.t.size(); ++i) {
    result.peak_velocity = std::max(result.peak_velocity, peaks.pad_velocity[i]);
    result.peak_displacement = std::max(result.peak_displacement, peaks.pad_displacement[i]);
  }
  const Windows& windows = run.windows;
  const std::size_t first = std::min(index_of(windows.t, result.from), windows.t.size() - 1);
  result.N_min = std::min(windows.N_up_min[first], windows.N_lo_min[first]);
  result.N_max = std::max(windows.N_up_max[first], windows.N_lo_max[first]);
  for (std::size_t i = first; i < windows.t.size(); ++i) {
    result.N_min = std::min({result.N_min, windows.N_up_min[i], windows.N_lo_min[i]});
    result.N_max = std::max({result.N_max, windows.N_up_max[i], windows.N_lo_max[i]});
    result.open += windows.open[i] / double(windows.t.size() - first);
  }
}

}  // namespace

MotionStatistics motion_statistics(const Transient& run)
{
  if (!run.finished) throw Error(fmt::format("motion statistics: {}", divergence_of(run)));
  if (run.history.t.size() < 2 || run.windows.t.empty())
    throw Error("motion statistics: the transient has no history; simulate it anew");
  const int n = rotations_of(run);
  const double from = run.history.t.back() - 2.0 * pi * n / run.speed;
  require_constant_speed(run, from);
  require_fine_history(run);
  const Samples x = samples_from(run, from);
  const std::size_t half = x.velocity.size() / 2;
  const double rms = std::sqrt(mean_square(x.velocity));
  const double before = std::sqrt(mean_square(x.velocity.first(half)));
  const double after = std::sqrt(mean_square(x.velocity.last(half)));
  const double drift = rms > 0.0 ? (after - before) / rms : 0.0;
  MotionStatistics result{.speed = run.speed,
                          .from = from,
                          .n_rotations = n,
                          .band_Hz = run.band.to_Hz,
                          .rms_velocity = rms,
                          .peak_velocity = 0.0,
                          .rms_displacement = rms_about_mean(x.displacement),
                          .peak_displacement = 0.0,
                          .N_min = 0.0,
                          .N_max = 0.0,
                          .open = 0.0,
                          .drift = drift,
                          .settled = std::abs(drift) < settled_rms_drift,
                          .rms_over_angle = rms_over_angle(x, run.speed),
                          .modulation = 0.0,
                          .lines = lines_of(x, run.speed)};
  const double high = result.rms_over_angle.maxCoeff(), low = result.rms_over_angle.minCoeff();
  if (high > 0.0) result.modulation = (high - low) / (high + low);
  add_extremes(result, run);
  return result;
}

}  // namespace chladni::squeal
