#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/motion/autonomous_motion.hpp"

namespace chladni::squeal {

/// An eigenvector of the sliding disc as a motion Re(v exp(lambda t)) that displaces the first
/// upper pad by an amplitude, m.
Eigen::VectorXcd moving_the_pad(AutonomousMotion& motion, const Eigen::VectorXcd& u,
                                double displacement);

/// A motion that may be near a limit cycle.
struct CycleGuess {
  HarmonicCycle cycle;
  double amplitude;  ///< of the first upper pad, in compressions at rest
  bool balanced;     ///< its averaged growth is zero
};

/// Where a limit cycle may be, without an integration: motions s Re(v exp(i omega t)) along the
/// least stable eigenvector v of the sliding disc, whose growth averaged over a period,
///   s'/s = Re(y^T F_1(s)) / s,   F_1 = (1 / pi) int f(s Re(v exp(i tau))) exp(-i tau) dtau,
/// changes from growth to decay with the amplitude s; y is the left eigenvector, y^T v = 1.
/// @param A            state matrix of the sliding disc, in the first rows of the motion
/// @param compression  of the first pad at rest, m: from a tenth of it to 800 times as much
/// @return by rising amplitude; then others, to be tried when these do not lead to a cycle
std::vector<CycleGuess> cycle_guesses(AutonomousMotion& motion, const Eigen::MatrixXd& A,
                                      double compression);

}  // namespace chladni::squeal
