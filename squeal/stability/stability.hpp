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

}  // namespace chladni::squeal
