#pragma once

#include <Eigen/Core>

#include "squeal/stability/angle_series.hpp"
#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

/// What the equations of a turning brake depend on the angle by.
struct TurningHarmonics {
  int nu;       ///< all harmonics are multiples of it; 0 when A is constant
  int highest;  ///< of those that are not negligible
  double left;  ///< sum of the norms of the harmonics left out, 1/s
};

/// Of A(phi), from samples that resolve every harmonic up to `bound`.
TurningHarmonics turning_harmonics(TurningBrake brake, int bound);

/// A(phi) in the eigenvectors of its mean A_0 = V diag(lambda) V^-1:
/// y' = (diag(lambda) + B(nu phi)) y with x = V y; the mean of B is zero.
struct TurningModes {
  double step;              ///< nu times the speed, rad/s: harmonic k turns by k step
  Eigen::VectorXcd lambda;  ///< [m] 1/s
  AngleSamples B;           ///< [m m x N] 1/s, each column a matrix, over one period 2 pi / nu
  Eigen::Index highest;     ///< harmonic of B, in multiples of nu

  Eigen::Index size() const { return lambda.size(); }
  Eigen::Map<const Eigen::MatrixXcd> at(Eigen::Index s) const
  {
    return {B.col(s).data(), size(), size()};
  }
};

/// @param N  samples, a power of two above twice the highest harmonic of A / nu
TurningModes turning_modes(TurningBrake brake, double speed, const TurningHarmonics& harmonics,
                           Eigen::Index N);

}  // namespace chladni::squeal
