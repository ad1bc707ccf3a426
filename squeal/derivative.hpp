#pragma once

#include <Eigen/Core>
#include <complex>

namespace chladni::squeal {

/// f(x + i h) / h has no difference in it: any h does whose square is far below rounding.
inline constexpr double complex_step = 1e-30;

/// df/dx [m x n] at x = 0 by complex steps, exact to rounding.
/// @param f  takes and returns an Eigen::VectorXcd; analytic at 0
/// @param n  size of x
template <class Function>
Eigen::MatrixXd derivative_at_rest(const Function& f, Eigen::Index n)
{
  Eigen::MatrixXd D;
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXcd x = Eigen::VectorXcd::Zero(n);
    x[j] = std::complex<double>(0.0, complex_step);
    const Eigen::VectorXd column = f(x).imag() / complex_step;
    if (j == 0) D.resize(column.size(), n);
    D.col(j) = column;
  }
  return D;
}

}  // namespace chladni::squeal
