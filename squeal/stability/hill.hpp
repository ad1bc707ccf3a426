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
  double error;          ///< estimated error of all growth rates that are no estimates, 1/s
  Eigen::Index coupled;  ///< largest number of states in one group
  int nu;                ///< the equations have nu periods in a rotation; 0: they are constant
  Eigen::VectorXd doubt = {};  ///< [n] of those that are estimates, 1/s; 0 of the others
};

/// A disc that stands at an angle, under pads that slide as if it turned.
struct FrozenDisc {
  double angle;       ///< rad
  double growth;      ///< largest, 1/s
  Eigen::MatrixXd A;  ///< 1/s
};

/// Motions exp(lambda t) r(phi) of a turning disc with their left vectors l(phi), both with the
/// period of the equations.
struct FloquetMotions {
  double step;                          ///< rad/s, nu times the speed
  Eigen::VectorXcd lambda;              ///< [k] 1/s, by descending growth
  std::vector<Eigen::MatrixXcd> right;  ///< [k] of [m x N]: r at the angles 2 pi s / (nu N)
  std::vector<Eigen::MatrixXcd> left;   ///< [k] of [m x N]: l, with l^T r = 1 in the mean
  int nu;                               ///< periods of the equations in a rotation, at least 1
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

  /// The exponents of all motions; those not expected to grow are estimates by the second order of
  /// the harmonics, in a small part of the time.
  HillExponents followable(double speed) const;

  /// The motions that grow most, up to `n`, the first of them and others that grow. Of motions that
  /// act on each other some may be missing beside one that grows much faster.
  /// @param omega  the motion of this frequency (rad/s) alone, which need not grow
  FloquetMotions motions(double speed, Eigen::Index n, std::optional<double> omega = {}) const;

  /// The brake at a speed (rad/s) between other pads, in the coordinates of this one's motions.
  TurningBrake brake(const SquealOptions& options, double speed) const
  {
    return {disc_, coordinates_, options, speed};
  }

  /// Number of periods of the equations in a rotation at this speed (rad/s); 0: they are constant.
  int nu(double speed) const;

  /// The matrix A(phi) that grows most with the disc frozen at an angle phi, of 24 angles of a
  /// period taken from different periods. Its growth is the true one only for an axisymmetric disc.
  /// @param nu  number of periods at this speed
  FrozenDisc worst_frozen(double speed, int nu) const;
  double frozen_growth(double speed, int nu) const { return worst_frozen(speed, nu).growth; }

  /// A_0, the mean of A(phi) over the turn in the coordinates z of the inertial frame: only what is
  /// not axisymmetric is averaged.
  Eigen::MatrixXd mean_matrix(double speed) const;

 private:
  struct Solved;
  Solved solved(double speed, const std::optional<GroupsAsked>& asked,
                Eigen::Index finer = 1) const;
  FloquetMotions motions_of(const Solved& found, const GroupsAsked& asked, Eigen::Index n,
                            std::optional<double> omega) const;
  HillExponents exponents_of(double speed, const std::optional<GroupsAsked>& asked) const;
  TurningHarmonics harmonics(double speed) const;
  TurningBrake brake(double speed) const { return brake(options_, speed); }

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

/// The periodic part of the motion of a group with one of its exponents, up to a factor.
/// @param lambda  the exponent, or a replica of it, 1/s
/// @return [g x N] at N angles of a period; empty where a faster growing motion of the group hides
///         it
Eigen::MatrixXcd group_motion(const NearGroup& group, double step, std::complex<double> lambda);

/// Characteristic exponents of y' = F(phi) y, phi = step t. For one state lambda is the mean of F.
/// For more states it follows from the eigenvalues mu of the product of exponentials of the Magnus
/// series of sixth order over one period T, lambda = ln mu / T; the time steps are halved until the
/// growth converges. Of the replicas lambda + i k step the one nearest to the mean of
/// Im(y* F y) / (y* y) is returned, which turns with the motion.
/// @param step  rad/s
GroupExponents group_exponents(const NearGroup& group, double step);

}  // namespace chladni::squeal
