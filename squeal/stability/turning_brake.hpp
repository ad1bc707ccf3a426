#pragma once

#include <Eigen/Core>

#include <vector>

#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

/// Coordinates z of the inertial frame for a disc that need not be axisymmetric: q = R exp(phi D) z
/// with D = [0 d; -d 0] for each pair of coordinates and 0 for the others. Any choice of pairs is
/// valid; it only affects how much of the equations depends on the angle phi.
struct TurningCoordinates {
  Eigen::MatrixXd R;  ///< [n_modes x n_modes] orthogonal
  /// [n_modes] nodal diameters; the two of a pair are adjacent, 0 for a single coordinate.
  std::vector<int> d;
};

/// Pairs each mode with the nearest frequency of the same dominant harmonic, if there is one within
/// 10 % whose shape is rotated relative to its own.
TurningCoordinates nearest_pairs(const Disc& disc);

/// The highest harmonic of the mode shapes along the rings and of the pairs.
int highest_harmonic(const Disc& disc, const TurningCoordinates& coordinates);

/// Small motions of a sliding disc and its pads, x' = A(phi) x with phi = speed t and x = (diag(w)
/// z, p), where p are the rates of the disc's material points in the coordinates z. The disc need
/// not be axisymmetric. A has the period 2 pi; for an axisymmetric disc it is constant and equal to
/// `state_matrix`.
class TurningBrake {
 public:
  TurningBrake(const Disc& disc, const TurningCoordinates& coordinates,
               const SquealOptions& options, double speed);

  /// A when the disc has rotated by `phi` (rad).
  /// @return [2 n x 2 n] 1/s, n = n_modes + modes of the pads
  Eigen::MatrixXd at(double phi);

  /// A(phi) X without A.
  /// @param X  [2 n x k]
  Eigen::MatrixXd times(double phi, const Eigen::MatrixXd& X);

  /// Displacements of the disc's modes, q, of states when the disc has rotated by `phi` (rad).
  /// @param z  [n_modes x k] coordinates
  Eigen::MatrixXd in_modes(double phi, const Eigen::MatrixXd& z) const;

  const Eigen::VectorXd& scale() const { return w_; }  ///< w of x = (diag(w) z, p), rad/s

 private:
  void place_points(double phi);
  /// Of the disc's coordinates, by -speed; zero for others.
  Eigen::MatrixXd convected(const Eigen::MatrixXd& z) const;
  Eigen::MatrixXd turned(const Eigen::MatrixXd& M, double phi) const;

  double speed_;
  std::vector<int> d_;
  Eigen::MatrixXd R_;
  PadSystem pads_;
  PointShapes shapes_;
  StackedContact contact_;  ///< shapes at the last angle
  /// Stiffness and damping of the disc without pads, in the coordinates at phi = 0.
  Eigen::MatrixXd K_, C_;
  Eigen::VectorXd w_;  ///< [n] rad/s, the same for both coordinates of a pair
};

/// Samples of functions of an angle, one function in each row: column s has the values at
/// 2 pi s / N, with N a power of two.
using AngleSamples = Eigen::MatrixXcd;
/// Fourier coefficients of f(phi) = sum_k c_k exp(i k phi): column k is c_k for k < N / 2, and
/// column N - k is c_-k.
using AngleHarmonics = Eigen::MatrixXcd;

/// The Fourier coefficients of samples.
AngleHarmonics harmonics_of(AngleSamples f);
/// The samples of a Fourier series.
AngleSamples samples_of(AngleHarmonics c);
/// The samples of a real one.
/// @param c  [n x K] the orders 1 to K < N / 2; the mean is zero
Eigen::MatrixXd samples_of_real(const Eigen::MatrixXcd& c, Eigen::Index N);

/// The order k of a column among N harmonics, -N / 2 < k <= N / 2.
inline Eigen::Index order_of(Eigen::Index column, Eigen::Index N)
{
  return column <= N / 2 ? column : column - N;
}

/// The column of the order k among N harmonics.
inline Eigen::Index column_of(Eigen::Index k, Eigen::Index N)
{
  return k < 0 ? N + k : k;
}

/// The smallest power of two that is at least `n`.
Eigen::Index power_of_two(Eigen::Index n);

/// Harmonics of A(phi) of x' = A(phi) x, phi = speed t, at one speed. The upper half of A, which
/// gives the rates of the coordinates, is constant.
struct TurningHarmonics {
  double speed;             ///< rad/s
  Eigen::MatrixXd A_0;      ///< [m x m] mean of A, 1/s
  Eigen::VectorXcd lambda;  ///< [m] 1/s, eigenvalues of A_0
  Eigen::MatrixXcd V;       ///< [m x m] eigenvectors of A_0
  Eigen::MatrixXcd left_V;  ///< [m x m / 2] columns of V^-1 that multiply the lower half of A
  /// [m m / 2 x highest + 1] 1/s, orders 0 to `highest` of the lower half of A, each a matrix.
  Eigen::MatrixXcd c;
  /// All kept harmonics are multiples of nu; 0: there are none.
  int nu;
  int highest;  ///< highest kept harmonic
  double left;  ///< estimated effect of the other harmonics on a growth rate, 1/s
};

/// Harmonics up to `bound` of the brake at this speed (rad/s). Harmonics that change the growth
/// rates by less than `budget` (1/s) in total are left out: first the smallest by their norm; then,
/// if the remaining ones without them have a common divisor, those caused by a mesh of unequal
/// elements. A harmonic b couples two states whose frequencies, shifted by its turns, differ by d,
/// and changes them by min(b, b^2 / d). This is an estimate, not a bound: d is taken from the
/// eigenvalues of A_0, and the shift by other harmonics may cause a resonance.
TurningHarmonics turning_harmonics(TurningBrake brake, double speed, int bound, double budget);

/// A(phi) in the eigenvectors of its mean A_0 = V diag(lambda) V^-1: y' = (diag(lambda) + P B(nu
/// phi) P^*) y with x = V y; the mean of B is zero. P = [1 i; 1 -i] / sqrt 2 for a conjugate pair
/// and 1 for a real eigenvalue: it is unitary, and V P and B are real.
struct TurningModes {
  double step;              ///< nu times the speed, rad/s; harmonic k has the frequency k step
  Eigen::VectorXcd lambda;  ///< [m] 1/s, the two of a conjugate pair adjacent
  Eigen::MatrixXd B;        ///< [m m x N] 1/s, each column a matrix, over one period 2 pi / nu
  Eigen::Index highest;     ///< highest harmonic of B, in multiples of nu
  Eigen::MatrixXcd B_k;     ///< [m m x highest] 1/s, harmonics of B from the first on

  Eigen::Index size() const { return lambda.size(); }  ///< m
  /// B at the sample s.
  Eigen::Map<const Eigen::MatrixXd> at(Eigen::Index s) const
  {
    return {B.col(s).data(), size(), size()};
  }
  /// That of order k > 0 of B; B is real, so that of -k is its conjugate.
  Eigen::Map<const Eigen::MatrixXcd> harmonic(Eigen::Index k) const
  {
    return {B_k.col(k - 1).data(), size(), size()};
  }
};

/// The equations of the left vectors, backwards in phi: z' = (diag(lambda) + P B(-nu phi)^~ P^*) z
/// with z = V^T l and l^T x constant, where ~ is the transposition in these coordinates.
TurningModes adjoint_of(const TurningModes& modes);

/// The products P r and P^* y.
Eigen::MatrixXcd from_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd r);
Eigen::MatrixXcd to_real_pairs(const Eigen::VectorXcd& lambda, Eigen::MatrixXcd y);

/// The equations in the eigenvectors of A_0.
/// @param N  number of samples, a power of two above twice the highest kept harmonic / nu
TurningModes turning_modes(const TurningHarmonics& harmonics, Eigen::Index N);

}  // namespace chladni::squeal
