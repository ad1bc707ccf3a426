#pragma once

#include <Eigen/Core>
#include <complex>

namespace chladni::squeal {

/// Floquet multipliers of a periodic motion, the eigenvalues of its monodromy matrix.
struct FloquetMultipliers {
  /// [size] First the one along the cycle, which is 1, then the others by descending modulus.
  Eigen::VectorXcd values;
  /// |X f(x_0) - f(x_T)| / |f|, which is zero for the exact monodromy matrix X: the measured error
  /// of X.
  double defect;
  double condition;  ///< condition number of the largest of the others
  double error;      ///< estimated error of the largest modulus of the others

  /// The largest modulus of the multipliers except the one along the cycle.
  double largest() const { return std::abs(values[1]); }
  /// Distance of the largest modulus from 1, where stability changes.
  double distance() const { return std::abs(largest() - 1.0); }
  /// Whether the distance is a hundred times the error, so that a rough estimate of that tells the
  /// stability.
  bool is_told() const { return distance() >= 100.0 * error; }
};

/// The multipliers of a motion x' = f(x) with the one along the cycle removed before: with
/// Q = [f/|f|, Q_2] orthogonal,
///   Q^T X Q = [1 c^T; 0 B],
/// and the others are the eigenvalues of B. At a fold and at a Hopf point 1 is a double eigenvalue
/// of X, whose computed values are off by the square root of the error of X; it is a simple one of
/// B. The estimated error is five times the defect, which shows one direction of many, times the
/// condition number of the eigenvalue of B.
/// @param X         monodromy matrix, [size x size] with size > 1
/// @param f_start   f(x_0)
/// @param f_end     f(x_T)
FloquetMultipliers floquet_multipliers(const Eigen::MatrixXd& X, const Eigen::VectorXd& f_start,
                                       const Eigen::VectorXd& f_end);

}  // namespace chladni::squeal
