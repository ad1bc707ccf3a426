#pragma once

#include <Eigen/Core>

#include <limits>
#include <vector>

#include "linear/dense/dense_solvers.hpp"

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

/// A stiffness-to-mass ratio of the lower modes: the smallest K_ii / M_ii that is no round-off, in
/// K or in M; 1 where there is none.
/// @param R  [n x r] with K R = 0, R^T M R = I; r may be 0
double deflation_shift(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                       const Eigen::MatrixXd& R);

/// Cholesky factor of K + sigma M R R^T M, with the round-off of K along R removed.
/// @param K      [n x n], symmetric, positive definite on the complement of R
/// @param R      [n x r] with K R = 0, R^T M R = I; r may be 0
/// @param sigma  of the size of the lower eigenvalues: deflation_shift() of the whole problem
/// @throws chladni::Error when K is singular beyond R: not positive definite, or positive by
///         round-off along a motion without mass.
Eigen::LLT<Eigen::MatrixXd> deflated_factor(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                                            const Eigen::MatrixXd& R, double sigma);

/// The coordinates of two symmetric matrices in sets that neither couples with the others, each set
/// ascending, by its first coordinate. What is coupled by round-off is coupled.
std::vector<std::vector<Eigen::Index>> decoupled_coordinates(const Eigen::MatrixXd& K,
                                                             const Eigen::MatrixXd& M);

/// Modes of coordinates that are coupled to no others.
struct PartModes {
  std::vector<Eigen::Index> coordinates;
  Eigenmodes modes;  ///< in these coordinates
};

/// eigenmodes() of coordinates of a problem whose largest 1 / lambda is `mu_of_whole` or more: what
/// is round-off beside that has no mass.
Eigenmodes eigenmodes_of_part(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                              const Eigen::MatrixXd& R, double mu_of_whole,
                              double orthonormal_to = 1e-8);

/// The modes of all parts in n coordinates.
Eigenmodes merged(const std::vector<PartModes>& parts, Eigen::Index n);

/// The eigenvalues of a real matrix, of which no eigenvector is asked for; of a complex pair the
/// one with the positive imaginary part first. Takes a third of the time of Eigen::EigenSolver,
/// which transforms all of the triangle also where it keeps no vectors.
/// @param A  [n x n]
/// @throws chladni::Error where the QR iteration does not converge, as for what is not finite.
Eigen::VectorXcd real_eigenvalues(const Eigen::MatrixXd& A);

}  // namespace chladni::linear
