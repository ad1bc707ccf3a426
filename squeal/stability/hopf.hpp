#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// A of x' = A x over the parameter that is sought.
using StateMatrixOf = std::function<Eigen::MatrixXd(double value)>;

/// A value at which A has the eigenvalues +-i omega.
struct HopfPoint {
  double value;        ///< of the parameter
  double omega;        ///< rad/s
  Eigen::VectorXcd u;  ///< eigenvector of i omega, of norm 1
  int n_newton_steps;
};

/// Newton's method on g(omega, value) = 0, the last component of the bordered system
///   [A(value) - i omega I, b; c^H, 0] (u; g) = (0; 1),
/// which stays regular where A - i omega I is singular; derivatives of g from the adjoint system,
/// that of A by central differences. Quadratic: about four steps to rounding.
/// @param value, omega  where it begins
/// @param u             [n] an estimate of the eigenvector; b and c are made of it
/// @return absent when it does not converge within 30 steps
std::optional<HopfPoint> hopf_point(const StateMatrixOf& A, double value, double omega,
                                    const Eigen::VectorXcd& u);

/// Where the sliding brake loses its stability over a range of the parameter, at the speed of the
/// search; see stability_search.hpp. 128 values are looked at first. Searching the speed itself is
/// `critical_speed`.
/// @return `value` is where it is lost first; where it is regained, if it is never lost; absent if
///         neither happens in the range.
CriticalValue critical_value(const Brake& brake, const CriticalCase& search);

}  // namespace chladni::squeal
