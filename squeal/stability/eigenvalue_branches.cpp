#include "squeal/stability/eigenvalue_branches.hpp"

#include <algorithm>
#include <complex>
#include <limits>
#include <vector>

#include "linear/dense/real_eigenvalues.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

}  // namespace

Eigen::VectorXcd oscillating_eigenvalues(const Eigen::MatrixXd& A)
{
  const Eigen::VectorXcd lambda = linear::real_eigenvalues(A);
  std::vector<Complex> sorted(lambda.begin(), lambda.end());
  std::ranges::sort(sorted, [](const Complex& x, const Complex& y) {
    return x.imag() != y.imag() ? x.imag() > y.imag() : x.real() > y.real();
  });
  return Eigen::Map<const Eigen::VectorXcd>(sorted.data(), lambda.size() / 2);
}

Eigen::VectorXcd matched(const Eigen::VectorXcd& values, const Eigen::VectorXcd& expected)
{
  Eigen::MatrixXd distance(values.size(), values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    distance.row(i) = (expected.array() - values[i]).abs().transpose();
  Eigen::VectorXcd ordered(values.size());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    Eigen::Index i = 0, j = 0;
    distance.minCoeff(&i, &j);
    ordered[j] = values[i];
    distance.row(i).setConstant(std::numeric_limits<double>::infinity());
    distance.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return ordered;
}

}  // namespace chladni::squeal
