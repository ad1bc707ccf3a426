#include "squeal/brake/contact_branch.hpp"

#include <complex>

#include "squeal/derivative.hpp"

namespace chladni::squeal {

Eigen::MatrixXd force_derivative(const BrakePoint& point, const PairVector<double>& g,
                                 const PairVector<double>& g_dot,
                                 const std::pair<double, std::span<const double>>& at)
{
  using Complex = std::complex<double>;
  const Eigen::Index rows = g.size();
  Eigen::MatrixXd D(rows, 2 * rows);
  for (Eigen::Index j = 0; j < 2 * rows; ++j) {
    PairVector<Complex> x = g.cast<Complex>(), v = g_dot.cast<Complex>();
    (j < rows ? x[j] : v[j - rows]) += Complex(0.0, complex_step);
    D.col(j) = force_on_branch<Complex>(point, pair_motion(x, v), at.first, at.second).imag() /
               complex_step;
  }
  return D;
}

}  // namespace chladni::squeal
