#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The eigenvalue of A with the largest real part and Im >= 0.
std::complex<double> least_stable_eigenvalue(const Eigen::MatrixXd& A);

/// An eigenvalue and its eigenvector of norm 1.
struct EigenPair {
  std::complex<double> lambda;
  Eigen::VectorXcd u;
};
/// The eigenvalue of A with the largest real part and Im >= 0, with its eigenvector.
EigenPair least_stable_pair(const Eigen::MatrixXd& A);

/// Eigenvalues over the speeds, followed from speed to speed by extrapolation.
EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range);

/// Intervals of the speed in which sliding is unstable; see stability_search.hpp. At least 128
/// speeds, or `range.count` if that is more, are sampled first.
StabilityProfile stability_over_speed(const StateMatrixAt& A, const SpeedRange& range);

/// The same up to just above the critical speed, where there is one.
StabilityProfile stability_until_critical(const StateMatrixAt& A, const SpeedRange& range);

/// The lowest speed of the range at which stability is lost; absent when sliding is stable or
/// unstable in the whole range, or only regains its stability.
std::optional<CriticalSpeed> critical_speed(const StabilityProfile& profile);

/// One eigenvalue of A for each mode, by descending Im: of an oscillating pair the one with Im > 0,
/// of an overdamped pair the less damped one.
/// @param A  [2 n x 2 n]
/// @return [n]
/// @throws chladni::Error when the QR algorithm does not converge.
Eigen::VectorXcd oscillating_eigenvalues(const Eigen::MatrixXd& A);

/// The values in the order of `expected`; the closest pairs are matched first.
Eigen::VectorXcd matched(const Eigen::VectorXcd& values, const Eigen::VectorXcd& expected);

/// First-order change of an eigenvalue of A by its left and right eigenvectors, d lambda = l^T dA r
/// with l^T r = 1. It holds for simple eigenvalues; where two coincide, l^T r = 0 before scaling,
/// and the derivative is infinite.
class EigenvalueChange {
 public:
  /// The change of the eigenvalue nearest to `expected`.
  EigenvalueChange(const Eigen::MatrixXd& A, const std::complex<double>& expected);

  std::complex<double> lambda() const { return lambda_; }

  /// Condition number |l| |r| / |l^T r| of the eigenvalue: 1 for normal matrices, infinite where
  /// eigenvalues coincide.
  double condition() const { return left_.norm() * right_.norm(); }

  /// d lambda for a change dA of the matrix, in the unit of `dA`.
  std::complex<double> of(const Eigen::MatrixXd& dA) const
  {
    return left_.cwiseProduct(dA * right_).sum();
  }

 private:
  std::complex<double> lambda_;
  Eigen::VectorXcd right_, left_;
};

/// Complex shapes of the eigenvalues `map.lambda` of the sliding disc; see EigenvalueMap::shapes.
std::vector<Eigen::MatrixXcd> mode_shapes(const InertialDisc& disc, const SquealOptions& options,
                                          const EigenvalueMap& map);

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
