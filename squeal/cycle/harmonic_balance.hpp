#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "linear/dense/dense_solvers.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// A periodic motion as a Fourier series,
/// x(t) = X_0 + sum_k X_(2k-1) cos(k omega t) + X_(2k) sin(k omega t).
struct HarmonicCycle {
  Eigen::MatrixXd X;  ///< [size x 2 n_harmonics + 1]
  double omega;       ///< rad/s
};

/// Discretisation of the harmonic balance.
struct HarmonicResolution {
  int n_harmonics;
  int n_samples;     ///< samples of the forces per period; more than 2 n_harmonics
  double tolerance;  ///< relative change at which Newton's method has converged
};

/// Solves x' = f(x) for a periodic motion by harmonic balance: Newton's method on
///   omega D X - F(X) = 0,   <X', dX> = 0,
/// with the Fourier coefficients F of f from samples in time (alternating frequency-time method)
/// and exact derivatives of f. At kinks of f the coefficients decay algebraically: a few harmonics
/// give four digits, and shooting refines them.
/// @param start  series with at most as many harmonics
/// @return absent when Newton's method does not converge
std::optional<HarmonicCycle> harmonic_balance(AutonomousMotion& motion, const HarmonicCycle& start,
                                              const HarmonicResolution& resolution);

/// The equations of harmonic balance, linearised about a periodic motion.
class LinearBalance {
 public:
  /// @param n_samples  of the forces per period
  LinearBalance(AutonomousMotion& motion, HarmonicCycle at, int n_samples);

  const HarmonicCycle& at() const { return at_; }

  /// Derivative of the periodic motion by a parameter of f.
  /// @param more, less  the motion with a larger and a smaller value of the parameter
  /// @param difference  of the two values
  HarmonicCycle change(AutonomousMotion& more, AutonomousMotion& less, double difference) const;

 private:
  HarmonicCycle at_;
  Eigen::MatrixXd gamma_;
  Eigen::PartialPivLU<Eigen::MatrixXd> solver_;
};

/// The first harmonics of a motion with these equally spaced samples of one period.
/// @param states  [size x n_samples]
HarmonicCycle series_of(const Eigen::MatrixXd& states, double omega, int n_harmonics);

/// Equally spaced samples of one period.
/// @return [size x n_samples]
Eigen::MatrixXd samples_of(const HarmonicCycle& cycle, int n_samples);

/// The state x(0) of a series.
Eigen::VectorXd start_of(const HarmonicCycle& cycle);

/// The eigenvector `u` of the sliding disc, scaled and turned in phase so that the motion
/// Re(v exp(lambda t)) begins with the first upper pad at its largest displacement.
/// @param displacement  amplitude of the first upper pad, m
/// @return v in the coordinates of the motion
Eigen::VectorXcd moving_the_pad(AutonomousMotion& motion, const Eigen::VectorXcd& u,
                                double displacement);

/// A motion that may be near a limit cycle.
struct CycleGuess {
  HarmonicCycle cycle;
  double amplitude;  ///< amplitude of the first upper pad relative to its compression at rest
  bool balanced;     ///< whether its averaged growth is zero
};

/// Estimates of limit cycles without an integration: motions s Re(v exp(i omega t)) along the least
/// stable eigenvector v of the sliding disc, at the amplitudes s where the growth averaged over a
/// period,
///   s'/s = Re(y^T F_1(s)) / s,   F_1 = (1 / pi) int f(s Re(v exp(i tau))) exp(-i tau) dtau,
/// changes to decay; y is the left eigenvector with y^T v = 1.
/// @param A            state matrix of the sliding disc, which is the first block of the motion
/// @param compression  compression of the first pad at rest, m; amplitudes from 0.1 to 800 times it
///         are searched
/// @return balanced guesses by ascending amplitude, then others to be tried when these fail
std::vector<CycleGuess> cycle_guesses(AutonomousMotion& motion, const Eigen::MatrixXd& A,
                                      double compression);

}  // namespace chladni::squeal
