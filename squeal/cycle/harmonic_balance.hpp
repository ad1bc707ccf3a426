#pragma once

#include <Eigen/Core>
#include <optional>

#include "squeal/motion/autonomous_motion.hpp"

namespace chladni::squeal {

/// A periodic motion as a Fourier series,
/// x(t) = X_0 + sum_k X_(2k-1) cos(k omega t) + X_(2k) sin(k omega t).
struct HarmonicCycle {
  Eigen::MatrixXd X;  ///< [size x 2 n_harmonics + 1]
  double omega;       ///< rad/s
};

/// How finely a periodic motion is looked for.
struct HarmonicResolution {
  int n_harmonics;
  int n_samples;     ///< of the forces in a period; more than 2 n_harmonics
  double tolerance;  ///< relative change at which Newton's method has converged
};

/// The Fourier series that x' = f(x) leaves no residual in, by Newton's method on
///   omega D X - F(X) = 0,   <X', dX> = 0,
/// with the coefficients F of f from samples in time (alternating frequency and time) and with the
/// exact derivatives of f. Kinks of f make the coefficients decay algebraically: a few harmonics
/// give four digits, and shooting the rest.
/// @param start  with as many harmonics or fewer
/// @return absent when Newton's method does not converge.
std::optional<HarmonicCycle> harmonic_balance(AutonomousMotion& motion, const HarmonicCycle& start,
                                              const HarmonicResolution& resolution);

/// x(0) of a series.
Eigen::VectorXd start_of(const HarmonicCycle& cycle);

}  // namespace chladni::squeal
