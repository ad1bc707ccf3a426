#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "squeal/stability/eigenvalues.hpp"

/// State matrices of motions that know nothing of each other.
namespace chladni::squeal::test {

/// A real matrix with the eigenvalues of M and their conjugates.
inline Eigen::MatrixXd realified(const Eigen::MatrixXcd& M)
{
  Eigen::MatrixXd A(2 * M.rows(), 2 * M.cols());
  A << M.real(), -M.imag(), M.imag(), M.real();
  return A;
}

/// A motion that grows by itself.
struct Single {
  std::function<double(double)> growth;
  double omega;
};

inline StateMatrixOf side_by_side(const std::vector<Single>& motions)
{
  return [motions](double value) {
    const auto n = static_cast<Eigen::Index>(motions.size());
    Eigen::MatrixXcd M = Eigen::MatrixXcd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Single& motion = motions[static_cast<std::size_t>(i)];
      M(i, i) = {motion.growth(value), motion.omega};
    }
    return realified(M);
  };
}

}  // namespace chladni::squeal::test
