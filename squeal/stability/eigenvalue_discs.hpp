#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "squeal/stability/pole_sum.hpp"

namespace chladni::squeal {

/// The least stable eigenvalue of a matrix, with the others.
struct LeastStable {
  std::complex<double> lambda;  ///< eigenvalue with the largest real part
  Eigen::VectorXcd all;         ///< approximations of all eigenvalues with Im > 0
};

/// The eigenvalue of A = A_0 + U Y with the largest real part, from approximations of all
/// eigenvalues.
///
/// For distinct z_i, as many as A has eigenvalues, and the corrections w_i = det(z_i - A) / prod_(j
/// != i) (z_i - z_j), A has the eigenvalues of diag(z) - 1 w^T. By Gershgorin's theorem they lie in
/// the discs about z_i - w_i with the radii (n - 1) |w_i|, and a disc that does not meet others
/// contains exactly one. The iteration z_i <- z_i - w_i (Weierstrass) is repeated for the discs
/// that may contain the rightmost eigenvalue until they are small.
/// @param sum    characteristic polynomial of A
/// @param poles  all eigenvalues of A_0 with Im > 0, 1/s
/// @param start  [poles] approximations of the eigenvalues of A in any order; those that `sum`
///         leaves out must have their places in `poles`
/// @param trace  trace of A, 1/s
/// @return absent when the corrections do not become small, when the disc of the rightmost
///         eigenvalue meets another, and when the sum of the eigenvalues is not the trace
/// Source: B. T. Smith, Journal of the ACM 17 (1970) 661, for the discs.
std::optional<LeastStable> least_stable_in_discs(const PoleSum& sum, const Eigen::VectorXcd& poles,
                                                 const Eigen::VectorXcd& start, double trace);

}  // namespace chladni::squeal
