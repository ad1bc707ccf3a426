#pragma once

#include <Eigen/Core>

#include "squeal/stability/angle_series.hpp"
#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

/// Harmonics of A(phi) of x' = A(phi) x, phi = speed t, at one speed. The upper half of A, which
/// gives the rates of the coordinates, is constant.
struct TurningHarmonics {
  double speed;             ///< rad/s
  Eigen::MatrixXd A_0;      ///< [m x m] mean of A, 1/s
  Eigen::VectorXcd lambda;  ///< [m] 1/s, eigenvalues of A_0
  Eigen::MatrixXcd V;       ///< [m x m] eigenvectors of A_0
  Eigen::MatrixXcd left_V;  ///< [m x m / 2] columns of V^-1 that multiply the lower half of A
  AngleHarmonics c;         ///< [m m / 2 x N] lower half of A, each column a matrix, 1/s
  /// All kept harmonics are multiples of nu; 0: there are none.
  int nu;
  int highest;  ///< highest kept harmonic
  double left;  ///< estimated effect of the other harmonics on a growth rate, 1/s
};

/// Harmonics up to `bound` of the brake at this speed (rad/s). Harmonics that change the growth
/// rates by less than `budget` (1/s) in total are left out: first the smallest by their norm; then,
/// if the remaining ones without them have a common divisor, those caused by a mesh of unequal
/// elements. A harmonic b couples two states whose frequencies, shifted by its turns, differ by d,
/// and changes them by min(b, b^2 / d). This is an estimate, not a bound: d is taken from the
/// eigenvalues of A_0, and the shift by other harmonics may cause a resonance.
TurningHarmonics turning_harmonics(TurningBrake brake, double speed, int bound, double budget);

/// A(phi) in the eigenvectors of its mean A_0 = V diag(lambda) V^-1: y' = (diag(lambda) + P B(nu
/// phi) P^*) y with x = V y; the mean of B is zero. P = [1 i; 1 -i] / sqrt 2 for a conjugate pair
/// and 1 for a real eigenvalue: it is unitary, and V P and B are real.
struct TurningModes {
  double step;              ///< nu times the speed, rad/s; harmonic k has the frequency k step
  Eigen::VectorXcd lambda;  ///< [m] 1/s, the two of a conjugate pair adjacent
  Eigen::MatrixXd B;        ///< [m m x N] 1/s, each column a matrix, over one period 2 pi / nu
  Eigen::Index highest;     ///< highest harmonic of B, in multiples of nu

  Eigen::Index size() const { return lambda.size(); }  ///< m
  /// B at the sample s.
  Eigen::Map<const Eigen::MatrixXd> at(Eigen::Index s) const
  {
    return {B.col(s).data(), size(), size()};
  }
};

/// The products P r and P^* y.
Eigen::MatrixXcd from_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd r);
Eigen::MatrixXcd to_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd y);

/// The equations in the eigenvectors of A_0.
/// @param N  number of samples, a power of two above twice the highest kept harmonic / nu
TurningModes turning_modes(const TurningHarmonics& harmonics, Eigen::Index N);

}  // namespace chladni::squeal
