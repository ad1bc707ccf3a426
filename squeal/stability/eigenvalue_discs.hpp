#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "squeal/stability/pole_sum.hpp"

namespace chladni::squeal {

/// The eigenvalues of one matrix.
struct LeastStable {
  std::complex<double> lambda;  ///< the one with the largest real part
  Eigen::VectorXcd all;         ///< approximations of all with Im > 0
};

/// The eigenvalue of A = A_0 + U Y with the largest real part, from approximations of all.
///
/// For any distinct z_i, as many as A has eigenvalues, and the corrections
/// w_i = det(z_i - A) / prod_(j != i) (z_i - z_j), A has the eigenvalues of diag(z) - 1 w^T. By
/// Gershgorin these lie in the discs about z_i - w_i with the radii (n - 1) |w_i|, and a disc that
/// meets no other holds exactly one. z_i <- z_i - w_i (Weierstrass) is repeated for the discs that
/// may hold the rightmost eigenvalue, until these are small.
/// @param sum    of A
/// @param poles  all eigenvalues of A_0 with Im > 0, 1/s
/// @param start  [poles] approximations of the eigenvalues of A, in any order but that those which
///               `sum` leaves out stand where `poles` has them
/// @param trace  of A, 1/s
/// @return absent where the corrections do not become small, where the disc of the rightmost meets
///         another, and where the sum of the eigenvalues is not the trace.
/// Source: B. T. Smith, Journal of the ACM 17 (1970) 661, for the discs.
std::optional<LeastStable> least_stable_in_discs(const PoleSum& sum, const Eigen::VectorXcd& poles,
                                                 const Eigen::VectorXcd& start, double trace);

}  // namespace chladni::squeal
