#include "squeal/transient/decimator.hpp"

#include <algorithm>
#include <cmath>

#include "squeal/transient/windowed_sinc.hpp"

namespace chladni::squeal {
namespace {

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

}  // namespace chladni::squeal
