#include "squeal/cycle/floquet.hpp"

#include <algorithm>

#include "linear/dense/orthogonal_factor.hpp"
#include "linear/dense/real_eigenvalues.hpp"
#include "squeal/stability/eigenvalue_change.hpp"

namespace chladni::squeal {
namespace {

/// Errors of X in other directions than that of the defect, relative to it.
constexpr double other_directions = 5.0;

}  // namespace

FloquetMultipliers floquet_multipliers(const Eigen::MatrixXd& X, const Eigen::VectorXd& f_start,
                                       const Eigen::VectorXd& f_end)
{
  const Eigen::Index n = X.rows();
  const double speed = f_start.norm();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr{Eigen::MatrixXd(f_start)};
  const Eigen::MatrixXd Q = linear::columns_of_Q(qr, n);
  const Eigen::MatrixXd in_Q = Q.transpose() * X * Q;
  const Eigen::MatrixXd B = in_Q.bottomRightCorner(n - 1, n - 1);

  FloquetMultipliers multipliers{Eigen::VectorXcd(n), (X * f_start - f_end).norm() / speed, 0.0,
                                 0.0};
  multipliers.values[0] = in_Q(0, 0);
  multipliers.values.tail(n - 1) = linear::real_eigenvalues(B);
  std::sort(multipliers.values.begin() + 1, multipliers.values.end(),
            [](const auto& a, const auto& b) {
              return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
            });
  multipliers.condition = EigenvalueChange(B, multipliers.values[1]).condition();
  multipliers.error = other_directions * multipliers.defect * multipliers.condition;
  return multipliers;
}

}  // namespace chladni::squeal
