#pragma once

#include <Eigen/Core>
#include <limits>

namespace chladni::linear {

/// Eigenpairs of K x = lambda M x with X^T M X = I, lambda ascending.
struct Eigenmodes {
  Eigen::VectorXd lambda;  ///< [k], rad^2/s^2
  Eigen::MatrixXd X;       ///< [n x k]
  int n_massless;          ///< directions without mass (to round-off) that were left out
};

/// The modes of (K, M) that are M-orthogonal to the zero-energy vectors R (K R = 0, R^T M R = I).
/// Solved as M x = mu (K + sigma M R R^T M) x, whose largest eigenvalues mu = 1/lambda are the low
/// modes: these keep full relative accuracy, where the form in M^-1 K loses lambda_max / lambda.
/// @param K  [n x n], symmetric, positive definite on the complement of R
/// @param M  [n x n], symmetric, positive semidefinite
/// @param R  [n x r], r may be 0
/// @param orthonormal_to  modes of more than a thousand times the first frequency whose mass
///                        rounding lets less certain are left out as massless
/// @throws chladni::Error when K has more zero-energy vectors than R, or M is not semidefinite.
Eigenmodes eigenmodes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, const Eigen::MatrixXd& R,
                      double orthonormal_to = 1e-8);

/// Which of the modes are wanted.
struct LowestModes {
  double lambda_max = std::numeric_limits<double>::infinity();  ///< rad^2/s^2
  Eigen::Index most = std::numeric_limits<Eigen::Index>::max();
};

/// The first of these modes: all with lambda <= lambda_max and, where there is one, the next;
/// `most` at most. Block Lanczos with full reorthogonalisation, which for a few tens of many
/// coordinates takes a fraction of the time; all modes where it would not. `n_massless` is not
/// counted.
/// @throws chladni::Error as eigenmodes.
Eigenmodes lowest_eigenmodes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                             const Eigen::MatrixXd& R, const LowestModes& wanted);

/// The first of these lambda alone, from above and to a few per cent: by inverse iteration, for a
/// scale; 0 where there is none.
/// @throws chladni::Error as eigenmodes where K is singular beyond R.
double first_eigenvalue(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                        const Eigen::MatrixXd& R);

}  // namespace chladni::linear
