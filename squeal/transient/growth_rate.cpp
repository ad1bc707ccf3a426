#include "squeal/transient/growth_rate.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace chladni::squeal {

std::optional<double> growth_rate(const Envelope& envelope, double linear_limit)
{
  const auto& z = envelope.pad_displacement;
  const auto end = std::ranges::find_if(z, [&](double x) { return x > linear_limit; });
  const Eigen::Index n_linear = end - z.begin(), first = n_linear / 2, n = n_linear - first;
  if (n < 8) return std::nullopt;
  const Eigen::Map<const Eigen::ArrayXd> t(envelope.t.data() + first, n);
  const Eigen::Map<const Eigen::ArrayXd> v(envelope.pad_velocity.data() + first, n);
  if (!(v.minCoeff() > 0.0)) return std::nullopt;
  const Eigen::ArrayXd x = t - t.mean();
  return (x * v.log()).sum() / x.square().sum();
}

double told_rate(const Growth& growth)
{
  return growth.eigenvalue_rate.value_or(growth.rate);
}

bool disagree(double measured, double of_eigenvalue)
{
  return std::abs(measured - of_eigenvalue) > std::max(0.1 * std::abs(of_eigenvalue), 0.01);
}

std::string warning_of_growth(double measured, double of_eigenvalue)
{
  if (!disagree(measured, of_eigenvalue)) return {};
  return fmt::format(
      "its growth of {:.4g} 1/s is not that of the least stable motion, {:.4g} 1/s by the "
      "eigenvalues: other motions still prevail; simulate for longer",
      measured, of_eigenvalue);
}

}  // namespace chladni::squeal
