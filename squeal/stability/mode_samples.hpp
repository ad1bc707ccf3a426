#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

/// The motions of x' = A x at one value of the parameter, one of each mode; see
/// oscillating_eigenvalues.
struct ModeSample {
  double value;
  Eigen::VectorXcd lambda;  ///< [n] 1/s
  Eigen::MatrixXcd X;       ///< [2 n x n] right eigenvectors of norm 1
  Eigen::MatrixXcd Y;       ///< [2 n x n] left eigenvectors of norm 1, y^H A = lambda y^H
  Eigen::VectorXd doubt;    ///< [n] growth that rounding can make of a neutral motion, 1/s

  Eigen::Index size() const { return lambda.size(); }
  double growth(Eigen::Index j) const { return lambda[j].real(); }
  double doubt_of(Eigen::Index j) const { return doubt[j]; }
  bool is_unstable(Eigen::Index j) const { return growth(j) > doubt[j]; }
  StabilityPoint point(Eigen::Index j) const;
};

/// The motions in the order of `oscillating_eigenvalues`.
/// @throws chladni::Error when the QR iteration does not converge.
ModeSample mode_sample(const StateMatrixOf& A, double value);

/// Samples at equal distances, column j of each one motion that is followed by its shape: by the
/// MAC of the left and of the right eigenvectors, |x_i^H x_j| |y_i^H y_j|, and by the distance of
/// lambda from its extrapolation. Where shapes change so much between two samples that this does
/// not tell two motions apart, it is followed through values between them.
/// @param range  with one value or more
std::vector<ModeSample> followed_modes(const StateMatrixOf& A, const SearchRange& range);

/// The sample at a value between two others of the same order, t = 0 at the first.
ModeSample mode_sample_between(const StateMatrixOf& A, const ModeSample& low,
                               const ModeSample& high, double t);

}  // namespace chladni::squeal
