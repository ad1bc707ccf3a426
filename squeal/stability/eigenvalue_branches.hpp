#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// One eigenvalue of A for each mode, by descending Im: of an oscillating pair the one with Im > 0,
/// of an overdamped pair the less damped one.
/// @param A  [2 n x 2 n]
/// @return [n]
/// @throws chladni::Error when the QR algorithm does not converge.
Eigen::VectorXcd oscillating_eigenvalues(const Eigen::MatrixXd& A);

/// The values in the order of `expected`; the closest pairs are matched first.
Eigen::VectorXcd matched(const Eigen::VectorXcd& values, const Eigen::VectorXcd& expected);

}  // namespace chladni::squeal
