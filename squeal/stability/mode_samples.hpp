#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/results/stability_results.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

/// The motions of x' = A x at one value of the parameter, one for each mode; see
/// oscillating_eigenvalues.
struct ModeSample {
  double value;             ///< of the parameter
  Eigen::VectorXcd lambda;  ///< [n] 1/s
  Eigen::MatrixXcd X;       ///< [2 n x n] right eigenvectors of norm 1
  Eigen::MatrixXcd Y;       ///< [2 n x n] left eigenvectors of norm 1, y^H A = lambda y^H
  /// [n] growth rate that rounding errors may cause for a neutral motion, 1/s.
  Eigen::VectorXd doubt;

  Eigen::Index size() const { return lambda.size(); }
  double growth(Eigen::Index j) const { return lambda[j].real(); }
  double doubt_of(Eigen::Index j) const { return doubt[j]; }
  bool is_unstable(Eigen::Index j) const { return growth(j) > doubt[j]; }
  StabilityPoint point(Eigen::Index j) const;
};

/// The motions at a value, in the order of `oscillating_eigenvalues`.
/// @throws chladni::Error when the QR algorithm does not converge.
ModeSample mode_sample(const StateMatrixOf& A, double value);

/// Equally spaced samples whose column j is the same motion. Motions are followed by the MAC of
/// left and right eigenvectors, |x_i^H x_j| |y_i^H y_j|, and by the distance of lambda from its
/// extrapolation. If two motions cannot be distinguished between two samples, intermediate values
/// are computed.
/// @param range  with at least one value
std::vector<ModeSample> followed_modes(const StateMatrixOf& A, const SearchRange& range);

/// The sample between two others with the same order of motions, at t = 0 ... 1 from the first to
/// the second.
ModeSample mode_sample_between(const StateMatrixOf& A, const ModeSample& low,
                               const ModeSample& high, double t);

}  // namespace chladni::squeal
