#pragma once

#include <Eigen/Core>
#include <limits>

namespace chladni::linear {

/// Eigenpairs of K x = lambda M x with X^T M X = I, lambda ascending.
struct Eigenmodes {
  Eigen::VectorXd lambda;  ///< [k], rad^2/s^2
  Eigen::MatrixXd X;       ///< [n x k]
  int n_massless;          ///< number of directions without mass (to round-off), left out
};

/// The modes of (K, M) that are M-orthogonal to the zero-energy vectors R (K R = 0, R^T M R = I).
/// The problem solved is M x = mu (K + sigma M R R^T M) x, whose largest eigenvalues mu = 1/lambda
/// are the low modes: they keep full relative accuracy, while a form with M^-1 K loses a factor
/// lambda_max / lambda.
/// @param K  [n x n], symmetric, positive definite on the complement of R
/// @param M  [n x n], symmetric, positive semidefinite
/// @param R  [n x r], r may be 0
/// @param orthonormal_to  modes of more than a thousand times the first frequency whose modal mass
///                        is less certain than this, by rounding, are left out as massless
/// @throws chladni::Error when K has more zero-energy vectors than R, or M is not semidefinite.
Eigenmodes eigenmodes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, const Eigen::MatrixXd& R,
                      double orthonormal_to = 1e-8);

/// The range of the wanted modes.
struct LowestModes {
  double lambda_max = std::numeric_limits<double>::infinity();  ///< rad^2/s^2
  Eigen::Index most = std::numeric_limits<Eigen::Index>::max();
};

/// The lowest of the modes of `eigenmodes`: all with lambda <= lambda_max and the next one, at most
/// `most`. Uses block Lanczos with full reorthogonalisation, which is much faster for a few tens of
/// modes of many coordinates; computes all modes if it would not be faster. `n_massless` is not
/// counted.
/// @throws chladni::Error as `eigenmodes`.
Eigenmodes lowest_eigenmodes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                             const Eigen::MatrixXd& R, const LowestModes& wanted);

/// An upper estimate, to a few per cent, of the first lambda of `eigenmodes`, by inverse iteration;
/// 0 if there is none.
/// @throws chladni::Error as `eigenmodes` when K is singular beyond R.
double first_eigenvalue(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                        const Eigen::MatrixXd& R);

}  // namespace chladni::linear
