#pragma once

#include <Eigen/Core>

#include "squeal/stability/angle_series.hpp"
#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

/// x' = A(phi) x of a turning brake at one speed, phi = speed t, by the harmonics of A. The upper
/// half of A, the rates of the coordinates, does not depend on the angle.
struct TurningHarmonics {
  double speed;             ///< rad/s
  Eigen::MatrixXd A_0;      ///< [m x m] 1/s, the mean of A
  Eigen::VectorXcd lambda;  ///< [m] 1/s, eigenvalues of A_0
  Eigen::MatrixXcd V;       ///< [m x m] eigenvectors of A_0
  Eigen::MatrixXcd left_V;  ///< [m x m / 2] columns of V^-1 that the lower half of A meets
  AngleHarmonics c;         ///< [m m / 2 x N] 1/s, of the lower half of A, each column a matrix
  int nu;                   ///< all harmonics that are kept are multiples of it; 0: there is none
  int highest;              ///< of those that are kept
  double left;              ///< what those left out move a growth rate by, estimated, 1/s
};

/// Harmonics up to `bound` of the brake at this speed (rad/s). Left out is what moves the growth
/// rates by less than `budget` (1/s) in all: the smallest harmonics by their norm; then, if the
/// others have a common divisor without them, those that a mesh of unequal elements makes: b
/// couples two states whose frequencies, with the turns of the harmonic, are d apart, and moves
/// them by min(b, b^2 / d). That is no bound: d is that of the eigenvalues of A_0, and what the
/// other harmonics add to them may make a resonance.
TurningHarmonics turning_harmonics(TurningBrake brake, double speed, int bound, double budget);

/// A(phi) in the eigenvectors of its mean A_0 = V diag(lambda) V^-1:
/// y' = (diag(lambda) + P B(nu phi) P^*) y with x = V y; the mean of B is zero. P = [1 i; 1 -i] /
/// sqrt 2 for the two of a conjugate pair and 1 for a real one: it is unitary, and V P and B are
/// real.
struct TurningModes {
  double step;              ///< nu times the speed, rad/s: harmonic k turns by k step
  Eigen::VectorXcd lambda;  ///< [m] 1/s, both of a conjugate pair behind each other
  Eigen::MatrixXd B;        ///< [m m x N] 1/s, each column a matrix, over one period 2 pi / nu
  Eigen::Index highest;     ///< harmonic of B, in multiples of nu

  Eigen::Index size() const { return lambda.size(); }
  Eigen::Map<const Eigen::MatrixXd> at(Eigen::Index s) const
  {
    return {B.col(s).data(), size(), size()};
  }
};

/// P r, and P^* y.
Eigen::MatrixXcd from_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd r);
Eigen::MatrixXcd to_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd y);

/// @param N  samples, a power of two above twice the highest harmonic kept / nu
TurningModes turning_modes(const TurningHarmonics& harmonics, Eigen::Index N);

}  // namespace chladni::squeal
