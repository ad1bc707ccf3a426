#pragma once

#include <Eigen/Core>
#include <complex>

namespace chladni::squeal {

/// Step h of complex-step derivatives f(x + i h) / h. They have no cancellation, so h^2 may be far
/// below rounding.
inline constexpr double complex_step = 1e-30;

/// df/dx at x = 0 by complex steps, exact to rounding.
/// @param f  function of an Eigen::VectorXcd, analytic at 0
/// @param n  size of x
/// @return [m x n]
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
