#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// Harmonics of the modes on the contact rings: row i of `c[d]` has the functions of mode i on each
/// ring as lengths (`functions_of`), Re(c exp(i d theta)). The harmonic n / 2 of a ring with n
/// nodes is left out, because its sine is unknown.
struct RingHarmonics {
  std::vector<Eigen::MatrixXcd> c;  ///< [d][n_modes x functions of all rings]

  /// [n_modes] sum of squares over all harmonics and functions.
  Eigen::VectorXd squares() const;
  /// [n_harmonics x n_modes] sum of squares of each harmonic over all functions.
  Eigen::MatrixXd squares_by_harmonic() const;
};

/// The harmonics of the modes on these rings.
RingHarmonics ring_harmonics(const std::vector<DiscRing>& rings);

/// The skew-symmetric matrix S that rotates modal coordinates as a rotation of the disc does, in
/// the least-squares sense. If the space of modes is closed under rotation and the disc is
/// axisymmetric, S c[d] / d = i c[d] on all rings, and S commutes with the stiffness; the second
/// condition has the weight (omega_i / omega_j - omega_j / omega_i)^2 for each entry. The
/// eigenvalues of S are then +-i d. The partners of modes are found in any order, even when modes
/// of close frequencies mix.
/// @param omega  [n_modes] rad/s
Eigen::MatrixXd rotation_generator(const RingHarmonics& harmonics, const Eigen::VectorXd& omega);

/// The modal coordinates with d nodal diameters, from the eigenvectors of a generator.
struct HarmonicSpace {
  int d;
  /// [n_modes x m] orthonormal. For d > 0 the columns e have S e = i d e, and their real and
  /// imaginary parts span 2 m dimensions; for d = 0 they are real.
  Eigen::MatrixXcd E;
};

/// The spaces of all d by ascending d, which together are the whole space; eigenvalues of S are
/// rounded to integers.
std::vector<HarmonicSpace> harmonic_spaces(const Eigen::MatrixXd& S);

}  // namespace chladni::squeal
