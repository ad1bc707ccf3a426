#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>

#include "squeal/motion/motion.hpp"

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

/// Start of a search for a periodic motion: a state and a period.
struct CycleStart {
  Eigen::VectorXd x;
  double period;  ///< s
};

/// x(T) and its derivatives by x(0). The motion is integrated by the method of order 8 with located
/// switching. The derivative is the product of exponentials of the Magnus series of order 4 along
/// the motion, with two Jacobians of f per 1/36 of the shortest period. If a contact switches
/// endlessly, `end` is not finite.
struct Flow {
  Eigen::VectorXd end;
  Eigen::MatrixXd derivative;  ///< [size x size]
};
/// Computes the flow over the period of `start`.
/// @param tolerance  relative tolerance of the integration
Flow flow(AutonomousMotion& motion, const CycleStart& start, double tolerance);

/// x(T) without its derivatives; not finite if a contact switches endlessly.
Eigen::VectorXd end_of(AutonomousMotion& motion, const CycleStart& start, double tolerance);

/// x at n equally spaced times of the period, from t = 0; not finite from the time on at which a
/// contact switches endlessly.
/// @return [size x n]
Eigen::MatrixXd states_over_period(AutonomousMotion& motion, const CycleStart& start, int n,
                                   double tolerance);

/// A periodic motion, x(T) = x(0).
struct PeriodicOrbit {
  CycleStart at;
  FloquetMultipliers multipliers;
  int n_newton_steps;
  double tolerance;  ///< of the integration, small enough for accurate multipliers
};

/// The periodic motion near `start` by shooting: Newton's method on
///   x(T; x_0) - x_0 = 0,   f(x_0) . dx_0 = 0
/// for x_0 and T. A monodromy matrix is reused as long as it reduces the change tenfold; the last
/// one belongs to the returned orbit. The tolerance of the integration is reduced until the defect
/// of the monodromy matrix is below 1e-6, and further while the largest multiplier is within a
/// hundred of its errors of 1. With two tolerances its error is their difference, in which the
/// error of the orbit is included.
/// @return absent when Newton's method does not converge
std::optional<PeriodicOrbit> periodic_orbit(AutonomousMotion& motion, const CycleStart& start);

/// A point of a branch as a periodic motion, without Newton steps, as at folds no step converges.
/// Its multipliers are computed as those of `periodic_orbit`.
/// @return absent when a contact switches endlessly
std::optional<PeriodicOrbit> orbit_as_it_is(AutonomousMotion& motion, const CycleStart& at);

/// Tolerance of the integration of an orbit that shows the error of others.
inline constexpr double sharp_tolerance = 1e-12;

/// The start of an orbit after one more Newton step at the sharp tolerance.
/// @return absent when the step is not small
std::optional<CycleStart> sharper_start(AutonomousMotion& motion, const CycleStart& at);

}  // namespace chladni::squeal
