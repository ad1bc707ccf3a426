#include "squeal/transient/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chladni::squeal {

using std::numbers::pi;

namespace {

/// Low-pass kernel for a reduction of the sampling rate: a sinc with a Blackman window and 24 zeros
/// on either side. Its cut-off is 0.87 of the highest frequency `nyquist` of the lower rate:
/// frequencies below 0.76 of `nyquist` pass within 5e-4, frequencies above `nyquist` are attenuated
/// by 74 dB. Times and frequencies have reciprocal units.

/// Number of zeros of the sinc on either side.
inline constexpr int n_sinc_zeros = 24;

/// Cutoff over the highest frequency that the lower rate holds. With a Blackman window what lies
/// more than 6 / n_sinc_zeros of half the cutoff beyond it is lowered by 74 dB: the pass band ends
/// 1 / 8 below the cutoff, and the stop band begins about there above it.
constexpr double cutoff_part = 0.87;

/// Time beyond which the kernel is zero.
double half_width_of_sinc(double nyquist)
{
  return n_sinc_zeros / (2.0 * cutoff_part * nyquist);
}

/// The kernel at a time; its integral over all times is 1.
double windowed_sinc(double nyquist, double time)
{
  const double cutoff = cutoff_part * nyquist, x = 2.0 * cutoff * time;
  const double u = x / n_sinc_zeros;  // -1 to 1
  if (!(std::abs(u) < 1.0)) return 0.0;
  const double sinc = x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x);
  const double window = 0.42 + 0.5 * std::cos(pi * u) + 0.08 * std::cos(2.0 * pi * u);
  return 2.0 * cutoff * sinc * window;
}

constexpr int factor_max = 8;

}  // namespace

DecimatorStage::DecimatorStage(int factor, Eigen::Index n_signals)
    : factor_(factor), half_(static_cast<Eigen::Index>(half_width_of_sinc(0.5 / factor)))
{
  taps_.resize(2 * half_ + 1);
  for (Eigen::Index i = 0; i < taps_.size(); ++i)
    taps_[i] = windowed_sinc(0.5 / factor, double(i - half_));
  samples_.setZero(n_signals, 2 * taps_.size());
}

std::optional<Eigen::VectorXd> DecimatorStage::add(const Eigen::VectorXd& x)
{
  const Eigen::Index n = taps_.size(), at = n_in_ % n;
  samples_.col(at) = x;
  samples_.col(at + n) = x;
  ++n_in_;
  if (n_out_ * factor_ + half_ >= n_in_) return std::nullopt;
  return emit();
}

std::optional<Eigen::VectorXd> DecimatorStage::take_rest()
{
  if (n_out_ * factor_ >= n_in_) return std::nullopt;
  return emit();
}

/// sum_i w_i x_i / sum_i w_i over the samples that there are.
Eigen::VectorXd DecimatorStage::emit()
{
  const std::int64_t middle = n_out_++ * factor_;
  const std::int64_t first = std::max<std::int64_t>(middle - half_, 0);
  const std::int64_t last = std::min(middle + half_, n_in_ - 1);
  const Eigen::Index n = last - first + 1;
  const auto weights = taps_.segment(first - middle + half_, n);
  return samples_.middleCols(first % taps_.size(), n) * weights / weights.sum();
}

std::int64_t Decimation::every() const
{
  std::int64_t product = 1;
  for (int i = 0; i < n_stages; ++i) product *= factor;
  return product;
}

Decimation decimation_to(std::int64_t n, std::int64_t n_max)
{
  const double ratio = double(n) / double(n_max);
  Decimation decimation;
  if (ratio <= 1.0) return decimation;
  const double enough = 1.0 - 1e-9;  // of a power that rounds to more than the ratio
  decimation.n_stages =
      std::max(1, static_cast<int>(std::ceil(enough * std::log(ratio) / std::log(factor_max))));
  decimation.factor =
      std::max(2, static_cast<int>(std::ceil(enough * std::pow(ratio, 1.0 / decimation.n_stages))));
  while ((n - 1) / decimation.every() + 1 > n_max) ++decimation.factor;
  return decimation;
}

Decimator::Decimator(const Decimation& decimation, Eigen::Index n_signals)
    : stages_(static_cast<std::size_t>(decimation.n_stages),
              DecimatorStage(std::max(2, decimation.factor), n_signals))
{}

std::optional<Eigen::VectorXd> Decimator::add(const Eigen::VectorXd& x)
{
  return add_from(0, x);
}

std::optional<Eigen::VectorXd> Decimator::add_from(std::size_t stage, const Eigen::VectorXd& x)
{
  if (stage == stages_.size()) return x;
  const std::optional<Eigen::VectorXd> through = stages_[stage].add(x);
  return through ? add_from(stage + 1, *through) : std::nullopt;
}

std::vector<Eigen::VectorXd> Decimator::finish()
{
  std::vector<Eigen::VectorXd> rest;
  for (std::size_t i = 0; i < stages_.size(); ++i)
    while (const std::optional<Eigen::VectorXd> x = stages_[i].take_rest())
      if (const std::optional<Eigen::VectorXd> through = add_from(i + 1, *x))
        rest.push_back(*through);
  return rest;
}

namespace {

/// Entries of the table for each zero; linear interpolation errs by (pi / entries)^2 / 8.
constexpr int entries = 512;

}  // namespace

Resampler::Resampler(double step, int rate_Hz) : step_(step), rate_Hz_(rate_Hz)
{
  const double nyquist = 0.5 * std::min(1.0 / step, rate_Hz_);
  half_width_ = half_width_of_sinc(nyquist);
  const int n = n_sinc_zeros * entries;
  for (int i = 0; i <= n + 1; ++i)
    table_.push_back(step * windowed_sinc(nyquist, half_width_ * i / n));
  in_.resize(static_cast<std::size_t>(std::ceil(2.0 * half_width_ / step)) + 4);
}

double Resampler::kernel(double time) const
{
  const double at = std::abs(time) / half_width_ * (n_sinc_zeros * entries);
  const auto i = static_cast<std::size_t>(at);
  if (i + 2 >= table_.size()) return 0.0;
  return table_[i] + (at - double(i)) * (table_[i + 1] - table_[i]);
}

void Resampler::add(double x)
{
  in_[static_cast<std::size_t>(n_in_++) % in_.size()] = x;
  while (double(n_out_) / rate_Hz_ + half_width_ < (double(n_in_) - 0.5) * step_) emit();
}

/// The next sample: sum of kernel(t - t_i) x_i over those within the kernel.
void Resampler::emit()
{
  const double t = double(n_out_) / rate_Hz_;
  const auto size = static_cast<std::int64_t>(in_.size());
  const auto first = static_cast<std::int64_t>(std::ceil((t - half_width_) / step_ - 0.5));
  const auto last = static_cast<std::int64_t>(std::floor((t + half_width_) / step_ - 0.5));
  double sum = 0.0;
  for (std::int64_t i = std::max({first, n_in_ - size, std::int64_t{0}});
       i <= std::min(last, n_in_ - 1); ++i)
    sum += kernel(t - (double(i) + 0.5) * step_) * in_[static_cast<std::size_t>(i % size)];
  out_.push_back(static_cast<float>(sum));
  ++n_out_;
}

void Resampler::finish()
{
  while (double(n_out_) / rate_Hz_ < double(n_in_) * step_) emit();
}

}  // namespace chladni::squeal
