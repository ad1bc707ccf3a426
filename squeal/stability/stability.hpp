#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The eigenvalue of A with the largest real part and Im >= 0.
std::complex<double> least_stable_eigenvalue(const Eigen::MatrixXd& A);

/// The eigenvalue of A with the largest real part and Im >= 0, and its eigenvector of norm 1.
struct EigenPair {
  std::complex<double> lambda;
  Eigen::VectorXcd u;
};
EigenPair least_stable_pair(const Eigen::MatrixXd& A);

/// Eigenvalues over the speeds, followed from speed to speed by extrapolation.
EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range);

/// The intervals of the speed in which sliding is unstable; see stability_search.hpp. 128 speeds or
/// `range.count`, whichever is more, are looked at first.
StabilityProfile stability_over_speed(const StateMatrixAt& A, const SpeedRange& range);

/// The lowest speed of the range at which stability is lost; absent when the sliding disc is stable
/// or unstable in the whole range, or regains its stability only.
std::optional<CriticalSpeed> critical_speed(const StabilityProfile& profile);

}  // namespace chladni::squeal
