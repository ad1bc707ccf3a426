#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/motion/autonomous_motion.hpp"

namespace chladni::squeal {

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
