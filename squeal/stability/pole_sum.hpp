#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace chladni::squeal {

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

}  // namespace chladni::squeal
