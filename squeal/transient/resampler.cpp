#include "squeal/transient/resampler.hpp"

#include <algorithm>
#include <cmath>

#include "squeal/transient/windowed_sinc.hpp"

namespace chladni::squeal {
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
