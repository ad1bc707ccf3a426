#include "squeal/cycle/pad_amplitudes.hpp"

#include <algorithm>

namespace chladni::squeal {
namespace {

/// The largest sample and what lies beside it.
struct Summit {
  Eigen::Index left, top, right;

  explicit Summit(const Eigen::VectorXd& x)
  {
    x.maxCoeff(&top);
    left = (top + x.size() - 1) % x.size();
    right = (top + 1) % x.size();
  }
  bool is_round(const Eigen::VectorXd& x) const { return x[left] < x[top] && x[right] < x[top]; }
  double slope(const Eigen::VectorXd& x) const { return x[right] - x[left]; }
  double bend(const Eigen::VectorXd& x) const { return x[left] - 2.0 * x[top] + x[right]; }
};

}  // namespace

double peak(const Eigen::VectorXd& x)
{
  const Summit at(x);
  if (!at.is_round(x)) return x[at.top];
  return x[at.top] - at.slope(x) * at.slope(x) / (8.0 * at.bend(x));
}

double peak_change(const Eigen::VectorXd& x, const Eigen::VectorXd& dx)
{
  const Summit at(x);
  if (!at.is_round(x)) return dx[at.top];
  const double ratio = at.slope(x) / at.bend(x);
  return dx[at.top] - ratio * at.slope(dx) / 4.0 + ratio * ratio * at.bend(dx) / 8.0;
}

PadAmplitudes pad_amplitudes(const Eigen::VectorXd& z, const Eigen::VectorXd& z_dot)
{
  return {std::max(peak(z_dot), peak(-z_dot)), 0.5 * (peak(z) + peak(-z))};
}

}  // namespace chladni::squeal
