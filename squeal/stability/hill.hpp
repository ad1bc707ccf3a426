#pragma once

#include <Eigen/Core>

#include "squeal/brake/disc.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/stability/turning_brake.hpp"
#include "squeal/stability/turning_modes.hpp"

namespace chladni::squeal {

/// Characteristic exponents of a sliding disc of any kind: its small motions in the inertial frame
/// are sums of exp(lambda t) f(speed t), f with the period of a rotation.
struct HillExponents {
  /// [n] 1/s, one of each complex pair, by falling growth; of the replicas lambda + i k nu speed
  /// that one whose frequency is the motion's in the inertial frame.
  Eigen::VectorXcd lambda;
  int harmonics;         ///< K, of the rotation, kept in the corrections by distant states
  double error;          ///< estimated, of all growth rates, 1/s
  Eigen::Index coupled;  ///< the largest number of states that are near each other
  int nu;                ///< the equations have the period of this part of a rotation; 0: constant
};

/// Hill's method: the motion and the equations are expanded into harmonics of the rotation,
///   (lambda + i k nu speed) x_k = sum_j A_(k-j) x_j,  |k| <= K.
/// This ladder is not solved as one matrix. In the eigenvectors of A_0 it is split into groups of
/// states that are near each other in frequency; the corrections by all other states, harmonic by
/// harmonic, make each group exact up to K (see near_groups.hpp), and the exponents of a group are
/// those of its few equations (see group_exponents.hpp). So none can be lost: there is one for each
/// state, and the sum of their growth rates is checked against the trace of A_0. K is doubled until
/// the last harmonics move the exponents by less than `tolerance`.
class Hill {
 public:
  /// @param tolerance  1/s
  Hill(const Disc& disc, const SquealOptions& options, double tolerance = 1e-4);

  /// @param speed  rad/s, > 0
  /// @throws chladni::Error when K = 512 nu is not enough.
  HillExponents exponents(double speed) const;

  /// The equations at this speed (rad/s) have the period of this part of a rotation; 0: constant.
  int nu(double speed) const;

  /// The largest growth rate (1/s) among the eigenvalues of the matrices A(phi) with the disc
  /// standing at some angle phi, over 24 angles of a period, which lie in different periods: exact
  /// for an axisymmetric disc alone.
  /// @param nu  at this speed
  double frozen_growth(double speed, int nu) const;

 private:
  TurningHarmonics harmonics(double speed) const;
  TurningBrake brake(double speed) const { return {disc_, coordinates_, options_, speed}; }

  Disc disc_;
  SquealOptions options_;
  double tolerance_;
  TurningCoordinates coordinates_;
  int bound_;  ///< no harmonic of A is higher
};

}  // namespace chladni::squeal
