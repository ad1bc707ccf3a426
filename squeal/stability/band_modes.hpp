#pragma once

#include <Eigen/Core>

namespace chladni::squeal {

/// Eigenvalues of a state matrix within a band, and their right eigenvectors.
struct BandModes {
  Eigen::VectorXcd lambda;  ///< [k] 1/s, by ascending frequency
  Eigen::MatrixXcd X;       ///< [n x k] of norm 1
};

/// All eigenvalues with 0 < Im <= highest, whatever their damping. Matrices of up to 300 rows are
/// solved by the QR iteration, larger ones by shift-and-invert block Arnoldi about i highest / 2,
/// whose space grows until all eigenvalues with |Re| <= highest / 2 have residuals below 1e-9 of
/// their size and one beyond them is known. Where the QR iteration without vectors finds other
/// eigenvalues of the band, more damped or growing faster, it solves the larger ones too.
/// Eigenvalues of a multiplicity up to that of a block, four, are all found.
/// @param A        [n x n] real, 1/s
/// @param highest  rad/s, > 0
BandModes band_modes(const Eigen::MatrixXd& A, double highest);

}  // namespace chladni::squeal
