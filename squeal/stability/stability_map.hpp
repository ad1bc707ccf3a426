#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <optional>
#include <vector>

#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The values and speeds of a map, and room for what it tells there.
StabilityMap empty_map(const MapCase& range, const SpeedRange& speeds);

/// Least stable eigenvalues of the brake over the speeds and the parameter of `range`.
/// @param n_threads  0: as many as processors; the result does not depend on it
StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads = 0);

/// The i-th state matrix of a sequence.
using MatrixOf = std::function<Eigen::MatrixXd(Eigen::Index i)>;

/// How often each method computed the eigenvalues of a sequence.
struct SequenceCount {
  Eigen::Index by_discs;  ///< from the eigenvalues of the previous matrix; see eigenvalue_discs.hpp
  Eigen::Index by_qr;     ///< by the QR algorithm
};

/// The least stable eigenvalue of each matrix of a sequence along which one parameter changes: the
/// one with the largest real part and Im >= 0, 1/s.
struct LeastStableSequence {
  Eigen::VectorXcd lambda;
  SequenceCount count;
};

/// Computes the least stable eigenvalues of n matrices. If neighbours differ by a matrix of low
/// rank, as when the pads of a disc change, all eigenvalues are extrapolated from matrix to matrix
/// and corrected. If this does not identify the rightmost eigenvalue with certainty, and for other
/// sequences, the QR algorithm is used.
LeastStableSequence least_stable_eigenvalues(const MatrixOf& A, Eigen::Index n);

/// The characteristic polynomial of A = A_0 + U Y relative to that of A_0: det(z - A) = det N(z)
/// prod (z - lambda_k), N(z) = I - sum_k R_k / (z - lambda_k), over the eigenvalues lambda_k of A_0
/// and their conjugates. Eigenvalues that U Y does not change are also those of A and are left out.
struct PoleSum {
  std::vector<Eigen::Index> modes;  ///< [m] indices of the remaining eigenvalues of A_0
  Eigen::VectorXcd poles;           ///< [m] these eigenvalues, Im > 0, 1/s
  /// [2 r^2 x m] a_k over b_k, column by column: R_k / (z - lambda_k) plus its conjugate is (a_k
  /// z + b_k) / ((z - lambda_k) (z - conj(lambda_k))).
  Eigen::MatrixXd numerators;
  Eigen::Index rank;  ///< r
};

/// Matrices that differ from A_0 by a change of low rank, in the eigenvectors of A_0.
class LowRankChange {
 public:
  /// Prepares the evaluation of matrices A_0 + U Y with a common U.
  /// @param samples  matrices from which the columns U of the changes are found
  /// @return absent when A_0 has real eigenvalues or nearly dependent eigenvectors, and when the
  ///         rank is so high that the QR algorithm is faster
  static std::optional<LowRankChange> about(const Eigen::MatrixXd& A_0,
                                            const std::vector<Eigen::MatrixXd>& samples);

  /// [n / 2] eigenvalues of A_0 with Im > 0, 1/s.
  const Eigen::VectorXcd& poles() const { return poles_; }

  /// The characteristic polynomial of A; absent when A - A_0 has columns outside U, beyond
  /// rounding.
  std::optional<PoleSum> sum_of(const Eigen::MatrixXd& A) const;

 private:
  LowRankChange() = default;

  Eigen::MatrixXd A_0_;
  Eigen::MatrixXd U_;        ///< [n x r] orthonormal
  double rounding_ = 0.0;    ///< limit below which a column of a change is rounding, 1/s
  Eigen::VectorXcd poles_;   ///< [n / 2]
  Eigen::MatrixXd re_, im_;  ///< [n x n / 2] right eigenvectors of the poles
  Eigen::MatrixXcd left_;    ///< [n / 2 x r] left eigenvectors times U
};

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
