#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// State matrix A of x' = A x as a function of the parameter.
using StateMatrixOf = std::function<Eigen::MatrixXd(double value)>;

/// A value at which A has the eigenvalues +-i omega.
struct HopfPoint {
  double value;        ///< value of the parameter
  double omega;        ///< rad/s
  Eigen::VectorXcd u;  ///< eigenvector of i omega with norm 1
  int n_newton_steps;
};

/// Newton's method on g(omega, value) = 0, where g is the last component of the bordered system
///   [A(value) - i omega I, b; c^H, 0] (u; g) = (0; 1),
/// which remains regular when A - i omega I is singular. Derivatives of g come from the adjoint
/// system, those of A from central differences. Convergence is quadratic: about four steps to
/// rounding.
/// @param value, omega  start values
/// @param u             [n] estimate of the eigenvector, from which b and c are made
/// @return absent when it does not converge within 30 steps
std::optional<HopfPoint> hopf_point(const StateMatrixOf& A, double value, double omega,
                                    const Eigen::VectorXcd& u);

/// The value of a parameter where the sliding brake loses its stability, at the speed of the
/// search; see stability_search.hpp. 128 values are sampled first. For the speed itself use
/// `critical_speed`.
/// @return `value` is the first loss of stability or, if it is never lost, the first regain; absent
///         if neither is in the range
CriticalValue critical_value(const Brake& brake, const CriticalCase& search);

}  // namespace chladni::squeal
