#include "squeal/growth_rate.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace chladni::squeal {

std::optional<double> growth_rate(const Envelope& envelope, double linear_limit)
{
  const auto& z = envelope.pad_displacement;
  const auto end = std::find_if(z.begin(), z.end(), [&](double x) { return x > linear_limit; });
  const Eigen::Index n_linear = end - z.begin(), first = n_linear / 2, n = n_linear - first;
  if (n < 8) return std::nullopt;
  const Eigen::Map<const Eigen::ArrayXd> t(envelope.t.data() + first, n);
  const Eigen::Map<const Eigen::ArrayXd> v(envelope.pad_velocity.data() + first, n);
  if (!(v.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::ArrayXd x = t - t.mean();
  return (x * v.log()).sum() / x.square().sum();
}

}  // namespace chladni::squeal
