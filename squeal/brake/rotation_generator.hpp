#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// What modes do on the contact rings, harmonic by harmonic: row i of `c[d]` are the functions of
/// mode i on each ring, as lengths (`functions_of`), Re(c exp(i d theta)).
/// A function that n nodes of a ring cannot tell from its neighbour n - d, d = n / 2, is left out.
struct RingHarmonics {
  std::vector<Eigen::MatrixXcd> c;  ///< [d][n_modes x functions of all rings]

  /// [n_modes] squares summed over all harmonics.
  Eigen::VectorXd squares() const;
  /// Row i of all harmonics, squares of each: [n_harmonics x n_modes].
  Eigen::MatrixXd squares_by_harmonic() const;
};

RingHarmonics ring_harmonics(const std::vector<DiscRing>& rings);

/// The skew matrix S that turns a space of modes like a rotation of the disc, as far as there is
/// one. Where the space is closed under rotation and the disc the same in every position,
/// S c[d] / d = i c[d] on all rings, and S commutes with the stiffness: both by least squares, the
/// second with the weight (omega_i / omega_j - omega_j / omega_i)^2 of each entry. Its eigenvalues
/// are then +-i d; modes find their partners in the space, whatever their order and however modes
/// of neighbouring frequencies mix.
/// @param omega  [n_modes] rad/s
Eigen::MatrixXd rotation_generator(const RingHarmonics& harmonics, const Eigen::VectorXd& omega);

/// The modal coordinates that have d nodal diameters, by the eigenvectors of a generator.
struct HarmonicSpace {
  int d;
  /// [n_modes x m] orthonormal; for d > 0 the columns e with S e = i d e, whose real and imaginary
  /// parts span 2 m dimensions; for d = 0 real.
  Eigen::MatrixXcd E;
};

/// Spaces that together are the whole one, by rising d; eigenvalues of S go to the nearest integer.
std::vector<HarmonicSpace> harmonic_spaces(const Eigen::MatrixXd& S);

}  // namespace chladni::squeal
