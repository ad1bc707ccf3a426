#include "sound/splines.hpp"

#include <algorithm>

namespace chladni::sound {

Splines::Splines(double length, int n_intervals) : length_(length), n_intervals_(n_intervals) {}

Eigen::RowVectorXd Splines::evaluate(double s, int derivative) const
{
  const double h = length_ / n_intervals_, x = std::clamp(s, 0.0, length_) / h;
  const int interval = std::min(static_cast<int>(x), n_intervals_ - 1);
  const double t = x - interval, u = 1.0 - t;
  Eigen::RowVectorXd B = Eigen::RowVectorXd::Zero(size());
  if (derivative == 0) {
    B.segment<4>(interval) << u * u * u, 3 * t * t * t - 6 * t * t + 4,
        3 * u * u * u - 6 * u * u + 4, t * t * t;
    return B / 6.0;
  }
  B.segment<4>(interval) << -u * u, 3 * t * t - 4 * t, -3 * u * u + 4 * u, t * t;
  return B / (2.0 * h);
}

Eigen::RowVectorXd Splines::values(double s) const
{
  return evaluate(s, 0);
}

Eigen::RowVectorXd Splines::slopes(double s) const
{
  return evaluate(s, 1);
}

}  // namespace chladni::sound
