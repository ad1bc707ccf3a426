#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/state_matrix.hpp"
#include "squeal/models/model.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// `state_matrix` over the speed; keeps references to its arguments.
StateMatrixAt state_matrix_at(const InertialDisc& disc, const SquealOptions& options);

/// The eigenvalue of A with the largest real part and Im >= 0.
std::complex<double> least_stable_eigenvalue(const Eigen::MatrixXd& A);
std::complex<double> least_stable_eigenvalue(const InertialDisc& disc, const SquealOptions& options,
                                             double speed);

/// The eigenvalue of A with the largest real part and Im >= 0, and its eigenvector of norm 1.
struct EigenPair {
  std::complex<double> lambda;
  Eigen::VectorXcd u;
};
EigenPair least_stable_pair(const Eigen::MatrixXd& A);

/// Eigenvalues over the speeds, followed from speed to speed by extrapolation.
EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range);
EigenvalueMap eigenvalues(const InertialDisc& disc, const SquealOptions& options);

/// The intervals of the speed in which sliding is unstable; see stability_search.hpp. 128 speeds or
/// `range.count`, whichever is more, are looked at first.
StabilityProfile stability_over_speed(const StateMatrixAt& A, const SpeedRange& range);
StabilityProfile stability_over_speed(const InertialDisc& disc, const SquealOptions& options);

/// The lowest speed of the range at which stability is lost; absent when the sliding disc is stable
/// or unstable in the whole range, or regains its stability only.
std::optional<CriticalSpeed> critical_speed(const StabilityProfile& profile);
std::optional<CriticalSpeed> critical_speed(const StateMatrixAt& A, const SpeedRange& range);
std::optional<CriticalSpeed> critical_speed(const InertialDisc& disc, const SquealOptions& options);

}  // namespace chladni::squeal
