#pragma once

#include <Eigen/Core>
#include <optional>

#include "squeal/motion/autonomous_motion.hpp"

namespace chladni::squeal {

/// Where the search for a periodic motion begins.
struct CycleStart {
  Eigen::VectorXd x;
  double period;  ///< s
};

/// x(T) and its derivatives by x(0). The motion is integrated with order 8 and located switching;
/// the derivative is the product of the exponentials of Magnus' series of order 4 along it, which
/// takes two derivatives of f for each 36th of the fastest period. Where a contact changes its side
/// without end, `end` is not finite; so are the states of the two functions below.
struct Flow {
  Eigen::VectorXd end;
  Eigen::MatrixXd derivative;  ///< [size x size]
};
Flow flow(AutonomousMotion& motion, const CycleStart& start, double tolerance);

/// x(T) alone.
Eigen::VectorXd end_of(AutonomousMotion& motion, const CycleStart& start, double tolerance);

/// x at `n` equal parts of the period, [size x n].
Eigen::MatrixXd states_over_period(AutonomousMotion& motion, const CycleStart& start, int n,
                                   double tolerance);

/// A periodic motion, x(T) = x(0).
struct PeriodicOrbit {
  CycleStart at;
  Eigen::MatrixXd monodromy;  ///< [size x size] dx(T) / dx(0)
  int n_newton_steps;
  double tolerance;  ///< of the integration: small enough for the multiplier along the cycle
};

/// The periodic motion near `start` by shooting: Newton's method on
///   x(T; x_0) - x_0 = 0,   f(x_0) . dx_0 = 0
/// for x_0 and T. A monodromy matrix serves as long as it reduces the change tenfold; the last one
/// belongs to the orbit that is returned. The tolerance of the integration falls until the
/// multiplier along the cycle is 1 to 1e-6.
/// @return absent when it does not converge.
std::optional<PeriodicOrbit> periodic_orbit(AutonomousMotion& motion, const CycleStart& start);

/// Eigenvalues of the monodromy matrix: the one nearest to 1 first, then by falling modulus.
Eigen::VectorXcd floquet_multipliers(const Eigen::MatrixXd& monodromy);

}  // namespace chladni::squeal
