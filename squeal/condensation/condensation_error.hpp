#pragma once

#include <Eigen/Core>

#include "squeal/condensation/condensation.hpp"

namespace chladni::squeal {

/// Compares the oscillations of a band with those of another state matrix, one with one.
/// @param exact    eigenvalues of the band, 1/s
/// @param A        of the condensed brake
/// @param wanted   band and tolerance
/// @return eigenvalues = 1 where one of the band is found that is none, or where one that grows or
///         decays by more than 1e-4 of its frequency does the opposite
CondensationError condensation_error(const Eigen::VectorXcd& exact, const Eigen::MatrixXd& A,
                                     const CondensationOptions& wanted);

/// The worst of both; numbers of eigenvalues and states add up.
CondensationError worst_of(const CondensationError& one, const CondensationError& other);

}  // namespace chladni::squeal
