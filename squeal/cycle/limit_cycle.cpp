#include "squeal/cycle/limit_cycle.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "common/error.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Times of the rising zeros of a sampled oscillation about its mean, by linear interpolation: the
/// curvature of an oscillation is zero there.
std::vector<double> rising_zeros(const History& tail)
{
  const std::vector<double>& x = tail.pad_velocity;
  std::vector<double> zeros;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i - 1] < 0.0 && x[i] >= 0.0)
      zeros.push_back(tail.t[i - 1] + (tail.t[i] - tail.t[i - 1]) * x[i - 1] / (x[i - 1] - x[i]));
  return zeros;
}

/// Slope of the least-squares line through the zeros over their numbers: the mean period.
double mean_period(const std::vector<double>& zeros)
{
  const auto n = static_cast<Eigen::Index>(zeros.size());
  const Eigen::Map<const Eigen::ArrayXd> t(zeros.data(), n);
  const Eigen::ArrayXd k =
      Eigen::ArrayXd::LinSpaced(n, 0.5 - 0.5 * double(n), 0.5 * double(n) - 0.5);
  return (k * t).sum() / k.square().sum();
}

/// The largest refined peak of |x|.
double amplitude_of_record(const std::vector<double>& t, const std::vector<double>& x)
{
  PeakFinder peaks;
  for (std::size_t i = 0; i < x.size(); ++i) peaks.add(t[i], x[i], t[1] - t[0]);
  const auto peak = peaks.take();
  return peak ? peak->value : 0.0;
}

/// Half the distance of the highest and the lowest refined peak.
double half_travel(const History& tail)
{
  const auto [low, high] = std::ranges::minmax_element(tail.pad_displacement);
  const double middle = 0.5 * (*low + *high);
  std::vector<double> x = tail.pad_displacement;
  for (double& value : x) value -= middle;
  return amplitude_of_record(tail.t, x);
}

/// Relative change of the velocity envelope over the last tenth of the run: means of the first and
/// the last fifth of it.
double relative_drift(const Envelope& envelope)
{
  const auto n = static_cast<Eigen::Index>(envelope.t.size());
  const Eigen::Map<const Eigen::VectorXd> v(envelope.pad_velocity.data(), n);
  const Eigen::VectorXd last = v.tail(std::max<Eigen::Index>(n / 10, 2));
  const Eigen::Index fifth = std::max<Eigen::Index>(last.size() / 5, 1);
  const double end = last.tail(fifth).mean();
  return (end - last.head(fifth).mean()) / end;
}

double time_of_99_percent(const Envelope& envelope, double end)
{
  std::size_t i = 0;
  while (i + 1 < envelope.t.size() && envelope.pad_velocity[i] < 0.99 * end) ++i;
  return envelope.t[i];
}

/// Least squares of a(t) = Re(amplitude exp(i omega t)) for each row over the tail.
Eigen::VectorXcd fundamental(const Eigen::MatrixXd& a, const std::vector<double>& t, double omega)
{
  const Eigen::Map<const Eigen::ArrayXd> time(t.data(), static_cast<Eigen::Index>(t.size()));
  Eigen::MatrixX2d waves(time.size(), 2);
  waves << (omega * time).cos(), -(omega * time).sin();
  const Eigen::Matrix2d normal = waves.transpose() * waves;
  const Eigen::MatrixX2d parts = (normal.inverse() * (a * waves).transpose()).transpose();
  const Eigen::VectorXcd sum = parts.col(0) + std::complex<double>(0.0, 1.0) * parts.col(1);
  Eigen::Index largest = 0;
  const double modulus = sum.cwiseAbs().maxCoeff(&largest);
  return sum * (std::conj(sum[largest]) / modulus);
}

}  // namespace

LimitCycle limit_cycle(const Transient& run)
{
  if (!run.finished) throw Error(fmt::format("limit cycle: {}", divergence_of(run)));
  const std::vector<double> zeros = rising_zeros(run.tail);
  if (zeros.size() < 10 || run.envelope.t.size() < 20) {
    throw Error(
        "limit cycle: the transient is too short to measure it; simulate at least 100 "
        "periods");
  }
  const double frequency = 1.0 / mean_period(zeros);
  const double velocity = amplitude_of_record(run.tail.t, run.tail.pad_velocity);
  const double drift = relative_drift(run.envelope);
  const auto [N_low, N_high] = std::ranges::minmax_element(run.tail.N_up);
  LimitCycle cycle{.speed = run.speed,
                   .frequency_Hz = frequency,
                   .pad_velocity = velocity,
                   .pad_displacement = half_travel(run.tail),
                   .N_min = *N_low,
                   .N_max = *N_high,
                   .drift = drift,
                   .settled = std::abs(drift) < settled_drift,
                   .t_zero_force = run.t_zero_force,
                   .t_99 = time_of_99_percent(run.envelope, velocity),
                   .mode_numbers = run.mode_numbers,
                   .amplitude = {}};
  if (run.tail_a.size() > 0)
    cycle.amplitude = fundamental(run.tail_a, run.tail.t, 2.0 * pi * frequency);
  return cycle;
}

bool has_unsettled_end(const SquealResults& results)
{
  return results.limit_cycle && !results.limit_cycle->settled;
}

}  // namespace chladni::squeal
