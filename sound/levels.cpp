#include "sound/levels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chladni::sound {
namespace {

using Eigen::Index, Eigen::MatrixX3d, Eigen::VectorXd;
using std::numbers::pi;

constexpr int n_azimuths = 72;
constexpr int n_polar = 73;

/// Points at equal angles on the circle of x around the axis, beginning with x itself.
MatrixX3d circle(const Eigen::Vector3d& x, Index n)
{
  MatrixX3d points(n, 3);
  for (Index i = 0; i < n; ++i) {
    const double angle = 2.0 * pi * double(i) / double(n), c = std::cos(angle), s = std::sin(angle);
    points.row(i) << c * x[0] - s * x[1], s * x[0] + c * x[1], x[2];
  }
  return points;
}

Heard listen_at(const std::vector<Tone>& tones, const Eigen::Vector3d& x)
{
  Heard heard{Eigen::VectorXcd(static_cast<Index>(tones.size())), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  // In a meridian plane another azimuth costs nothing.
  const bool meridian = !tones.empty() && tones[0].fields[0].mesh->dimension() == 2;
  const Index n = meridian ? 5 * n_azimuths : n_azimuths;
  VectorXd square = VectorXd::Zero(n);
  double weighted = 0.0;
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const Eigen::VectorXcd p = pressure_at(tones[i], circle(x, n));
    heard.pressure[Index(i)] = p[0];
    heard.peak = std::max(heard.peak, std::abs(p[0]));
    square += 0.5 * p.cwiseAbs2();
    weighted +=
        0.5 * std::norm(p[0]) * std::pow(10.0, 0.1 * A_weighting_dB(tones[i].omega / (2.0 * pi)));
  }
  const double rms = std::sqrt(square[0]);
  heard.rms_dB = level_dB(rms);
  heard.peak_dB = level_dB(std::numbers::sqrt2 * rms);
  heard.A_dB = level_dB(std::sqrt(weighted));
  heard.least = std::sqrt(square.minCoeff());
  heard.largest = std::sqrt(square.maxCoeff());
  return heard;
}

/// Linear between the points, constant beyond them.
double value_at(const Onset& onset, double t)
{
  const auto next = std::ranges::upper_bound(onset.t, t);
  if (next == onset.t.begin()) return onset.amplitude.front();
  if (next == onset.t.end()) return onset.amplitude.back();
  const auto i = static_cast<std::size_t>(next - onset.t.begin());
  const double s = (t - onset.t[i - 1]) / (onset.t[i] - onset.t[i - 1]);
  return (1.0 - s) * onset.amplitude[i - 1] + s * onset.amplitude[i];
}

/// Against the click of a sudden beginning or end.
double fading(double t, double duration)
{
  constexpr double ramp = 0.02;  // s
  const double near = std::min({t, duration - t, ramp}) / ramp;
  return 0.5 - 0.5 * std::cos(pi * near);
}

}  // namespace

double level_dB(double effective_pressure)
{
  return 20.0 * std::log10(std::max(effective_pressure, 1e-15) / reference_pressure);
}

double A_weighting_dB(double frequency_Hz)
{
  const auto response = [](double f) {
    const double f_2 = f * f;
    return 12194.0 * 12194.0 * f_2 * f_2 /
           ((f_2 + 20.6 * 20.6) * std::sqrt((f_2 + 107.7 * 107.7) * (f_2 + 737.9 * 737.9)) *
            (f_2 + 12194.0 * 12194.0));
  };
  return 20.0 * std::log10(response(frequency_Hz) / response(1000.0));
}

std::vector<Heard> listen(const std::vector<Tone>& tones,
                          const std::vector<Microphone>& microphones)
{
  std::vector<Heard> all;
  for (const Microphone& microphone : microphones) all.push_back(listen_at(tones, microphone.x));
  return all;
}

Directivity directivity(const std::vector<Tone>& tones)
{
  Directivity d{VectorXd::LinSpaced(n_polar, 0.0, pi),
                VectorXd::LinSpaced(n_azimuths, 0.0, 2.0 * pi * (n_azimuths - 1) / n_azimuths),
                Eigen::MatrixXd::Zero(n_polar, n_azimuths)};
  for (Index i = 0; i < n_polar; ++i) {
    const MatrixX3d e = circle({std::sin(d.polar[i]), 0.0, std::cos(d.polar[i])}, n_azimuths);
    for (const Tone& tone : tones) d.rms.row(i) += 0.5 * far_field(tone, e).cwiseAbs2().transpose();
  }
  d.rms = d.rms.cwiseSqrt().eval();
  return d;
}

std::vector<float> samples(const std::vector<Tone>& tones, const Eigen::VectorXcd& pressure,
                           const WavCase& wav, const Onset& onset)
{
  const auto n = static_cast<std::size_t>(wav.duration * wav.rate_Hz);
  std::vector<float> x(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double t = double(k) / wav.rate_Hz;
    const double a = onset.t.empty() ? fading(t, wav.duration) : value_at(onset, t);
    double p = 0.0;
    for (std::size_t i = 0; i < tones.size(); ++i) {
      if (tones[i].omega > pi * wav.rate_Hz) continue;  // cannot be told by samples
      p += std::pow(a, tones[i].h) *
           (pressure[Index(i)] * std::polar(1.0, tones[i].omega * t)).real();
    }
    x[k] = static_cast<float>(p);
  }
  return x;
}

}  // namespace chladni::sound
