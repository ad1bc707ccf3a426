#include "squeal/transient/spectrum.hpp"

#include <fmt/format.h>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include "common/error.hpp"

namespace chladni::squeal {

using Eigen::Index;
using std::numbers::pi;

namespace {

constexpr std::size_t samples_min = 64;
constexpr double smallest_peak = 1e-5;
constexpr std::size_t peaks_max = 32;

/// The largest product of 2, 3 and 5 up to n, and even: quick to transform.
std::size_t quick_length(std::size_t n)
{
  for (n -= n % 2; n > 2; n -= 2) {
    std::size_t rest = n;
    for (const std::size_t p : {2, 3, 5})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return n;
  }
  return n;
}

/// A peak between the lines k - 1, k, k + 1. The main lobe of the Hann window is
/// sin(pi d) / (pi d (1 - d^2)) at d lines from its centre.
Spectrum::Peak refined(const Eigen::VectorXd& amplitude, Eigen::Index k, double line_Hz)
{
  const bool right = amplitude[k + 1] > amplitude[k - 1];
  const double ratio = amplitude[right ? k + 1 : k - 1] / amplitude[k];
  const double d = (2.0 * ratio - 1.0) / (ratio + 1.0);
  const double lobe = std::abs(d) < 1e-9 ? 1.0 : std::sin(pi * d) / (pi * d * (1.0 - d * d));
  return {(double(k) + (right ? d : -d)) * line_Hz, amplitude[k] / lobe};
}

}  // namespace

Spectrum spectrum(std::span<const double> x, double step)
{
  if (x.size() < samples_min) {
    throw Error(
        fmt::format("spectrum: {} samples are too few; simulate at least 100 periods", x.size()));
  }
  const std::size_t n = quick_length(x.size());
  std::vector<double> windowed(x.end() - static_cast<std::ptrdiff_t>(n), x.end());
  double mean = 0.0;
  for (const double value : windowed) mean += value / double(n);
  for (std::size_t i = 0; i < n; ++i)
    windowed[i] = (windowed[i] - mean) * (1.0 - std::cos(2.0 * pi * double(i) / double(n)));
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, windowed);

  const auto n_lines = static_cast<Eigen::Index>(n / 2 + 1);
  const double line_Hz = 1.0 / (double(n) * step);
  Spectrum result{Eigen::VectorXd::LinSpaced(n_lines, 0.0, line_Hz * double(n_lines - 1)),
                  Eigen::VectorXd(n_lines),
                  {}};
  for (Eigen::Index k = 0; k < n_lines; ++k)
    result.amplitude[k] = 2.0 / double(n) * std::abs(lines[static_cast<std::size_t>(k)]);
  const Eigen::VectorXd& a = result.amplitude;
  for (Eigen::Index k = 1; k + 1 < n_lines; ++k)
    if (a[k] > a[k - 1] && a[k] >= a[k + 1] && a[k] > smallest_peak * a.maxCoeff())
      result.peaks.push_back(refined(a, k, line_Hz));
  std::ranges::sort(result.peaks,
                    [](const auto& p, const auto& q) { return p.amplitude > q.amplitude; });
  if (result.peaks.size() > peaks_max) result.peaks.resize(peaks_max);
  return result;
}

namespace {

constexpr std::size_t window_samples_min = 256, shortest_window = 64;
constexpr Index spectra_max = 200, frequencies_max = 1000, n_lines = 5;

/// Samples of a window: a fiftieth of the history, so that 200 windows overlap by three quarters.
std::size_t window_of(std::size_t n)
{
  return std::max(shortest_window, n / 50);
}

/// Rotation speed at a time, from the windows of the envelope; linear between them.
double speed_at(const Transient& run, double t)
{
  const Windows& windows = run.windows;
  if (windows.t.empty()) return run.speed;
  const auto next = std::ranges::upper_bound(windows.t, t) - windows.t.begin();
  if (next == 0) return windows.speed.front();
  if (next == std::ssize(windows.t)) return windows.speed.back();
  const auto i = static_cast<std::size_t>(next);
  const double s = (t - windows.t[i - 1]) / (windows.t[i] - windows.t[i - 1]);
  return (1.0 - s) * windows.speed[i - 1] + s * windows.speed[i];
}

/// The largest of each of `parts` runs of lines.
Eigen::VectorXd pooled(const Eigen::VectorXd& lines, Index width)
{
  Eigen::VectorXd largest((lines.size() + width - 1) / width);
  for (Index i = 0; i < largest.size(); ++i)
    largest[i] = lines.segment(i * width, std::min(width, lines.size() - i * width)).maxCoeff();
  return largest;
}

/// The amplitudes of window k, and its strongest lines.
void add_window(Spectrogram& result, Index k, const Spectrum& window, double to_Hz)
{
  const Index n = (window.frequency_Hz.array() <= to_Hz).count();
  const Index width = (n + frequencies_max - 1) / frequencies_max;
  const Eigen::VectorXd amplitude = pooled(window.amplitude.head(n), width);
  if (k == 0) {
    const Index n_f = amplitude.size();
    result.frequency_Hz = window.frequency_Hz[1] * double(width) *
                          Eigen::VectorXd::LinSpaced(n_f, 0.0, double(n_f - 1));
    result.amplitude.resize(result.t.size(), n_f);
  }
  result.amplitude.row(k) = amplitude;
  const auto n_peaks = std::min<Index>(n_lines, std::ssize(window.peaks));
  for (Index j = 0; j < n_peaks; ++j) {
    result.line_Hz(k, j) = window.peaks[std::size_t(j)].frequency_Hz;
    result.line_amplitude(k, j) = window.peaks[std::size_t(j)].amplitude;
  }
}

}  // namespace

Spectrogram spectrogram(const Transient& run)
{
  const std::vector<double>& v = run.history.pad_velocity;
  if (v.size() < window_samples_min) {
    throw Error(fmt::format("spectrogram: the history has {} samples; simulate at least {} of them",
                            v.size(), window_samples_min));
  }
  const std::size_t length = window_of(v.size());
  const auto n_t = std::min<Index>(spectra_max, Index((v.size() - length) / (length / 4)) + 1);
  const double step = 1.0 / run.band.rate_Hz;
  Spectrogram result{.t = Eigen::VectorXd(n_t),
                     .speed = Eigen::VectorXd(n_t),
                     .envelope = Eigen::VectorXd(n_t),
                     .frequency_Hz = {},
                     .amplitude = {},
                     .line_Hz = Eigen::MatrixXd::Zero(n_t, n_lines),
                     .line_amplitude = Eigen::MatrixXd::Zero(n_t, n_lines)};
  for (Index k = 0; k < n_t; ++k) {
    const std::size_t first =
        n_t > 1 ? (v.size() - length) * std::size_t(k) / std::size_t(n_t - 1) : 0;
    const std::span window = std::span(v).subspan(first, length);
    result.t[k] = run.history.t[first] + 0.5 * double(length - 1) * step;
    result.speed[k] = speed_at(run, result.t[k]);
    result.envelope[k] =
        std::abs(*std::ranges::max_element(window, {}, [](double x) { return std::abs(x); }));
    add_window(result, k, spectrum(window, step), run.band.to_Hz);
  }
  return result;
}

}  // namespace chladni::squeal
