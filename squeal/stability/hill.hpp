#pragma once

#include <Eigen/Core>

#include <optional>

#include "squeal/brake/disc.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/stability/near_groups.hpp"
#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

/// Characteristic exponents of a sliding disc that need not be axisymmetric. Its small motions in
/// the inertial frame are sums of exp(lambda t) f(speed t), where f has the period of a rotation.
struct HillExponents {
  /// [n] 1/s, one of each complex pair by descending growth. Of the replicas lambda + i k nu speed
  /// it is the one with the frequency of the motion in the inertial frame.
  Eigen::VectorXcd lambda;
  int harmonics;         ///< highest harmonic K in the corrections by distant states
  double error;          ///< estimated error of all growth rates, 1/s
  Eigen::Index coupled;  ///< largest number of states in one group
  int nu;                ///< the equations have nu periods in a rotation; 0: they are constant
};

/// Hill's method: motion and equations are expanded into harmonics of the rotation,
///   (lambda + i k nu speed) x_k = sum_j A_(k-j) x_j,  |k| <= K.
/// The infinite system is not solved as one matrix. In the eigenvectors of A_0 it is split into
/// groups of states with close frequencies. Corrections by all other states, harmonic by harmonic,
/// make each group exact up to K (see near_groups.hpp), and the exponents of a group follow from
/// its few equations (see group_exponents.hpp). So no exponent is lost: there is one for each
/// state, and the sum of the growth rates is checked against the trace of A_0. K is doubled until
/// the last harmonics change the exponents by less than `tolerance`.
class Hill {
 public:
  /// @param tolerance  error of the exponents, 1/s
  Hill(const Disc& disc, const SquealOptions& options, double tolerance = 1e-4);

  /// The exponents at a speed.
  /// @param speed           rad/s, > 0
  /// @param n_least_stable  those of so many motions that grow most, at least, in a small part of
  ///                        the time; their sum is not checked against the trace
  /// @throws chladni::Error when K = 512 nu is not sufficient.
  HillExponents exponents(double speed, std::optional<Eigen::Index> n_least_stable = {}) const;

  /// Number of periods of the equations in a rotation at this speed (rad/s); 0: they are constant.
  int nu(double speed) const;

  /// Largest growth rate (1/s) of the matrices A(phi) with the disc frozen at an angle phi, over 24
  /// angles of a period taken from different periods. This is the true growth only for an
  /// axisymmetric disc.
  /// @param nu  number of periods at this speed
  double frozen_growth(double speed, int nu) const;

 private:
  TurningHarmonics harmonics(double speed) const;
  TurningBrake brake(double speed) const { return {disc_, coordinates_, options_, speed}; }

  Disc disc_;
  SquealOptions options_;
  double tolerance_;
  TurningCoordinates coordinates_;
  int bound_;  ///< upper limit of the harmonics of A
};

/// Characteristic exponents of a group of states, with their error.
struct GroupExponents {
  Eigen::VectorXcd lambda;  ///< [g] 1/s
  double error;             ///< estimated error, 1/s
};

/// Characteristic exponents of y' = F(phi) y, phi = step t. For one state lambda is the mean of F.
/// For more states it follows from the eigenvalues mu of the product of exponentials of the Magnus
/// series of sixth order over one period T, lambda = ln mu / T; the time steps are halved until the
/// growth converges. Of the replicas lambda + i k step the one nearest to the mean of
/// Im(y* F y) / (y* y) is returned, which turns with the motion.
/// @param step  rad/s
GroupExponents group_exponents(const NearGroup& group, double step);

}  // namespace chladni::squeal
