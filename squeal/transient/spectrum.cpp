#include "squeal/transient/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

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

}  // namespace chladni::squeal
