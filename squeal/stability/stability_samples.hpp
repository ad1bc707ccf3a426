#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

/// The eigenvalues of A at one value of the parameter.
struct StabilitySample {
  double value;
  Eigen::VectorXcd lambda;  ///< one for each mode, in the order of the branches
  bool unstable;

  double growth() const { return lambda.real().maxCoeff(); }
};

/// Whether x' = A x grows faster than rounding errors can make a neutral motion grow; see
/// stability_over.
bool is_unstable(const Eigen::MatrixXd& A);

/// Growth rate, 1/s, that rounding errors may cause for a neutral motion whose eigenvalue has the
/// condition number 1.
double rounding_of(const Eigen::VectorXcd& lambda);

/// Equally spaced samples, with branches followed by extrapolation.
std::vector<StabilitySample> scan(const StateMatrixOf& A, const SearchRange& range);

/// Those of `scan` up to the first that is unstable after a stable one.
std::vector<StabilitySample> scan_until_loss(const StateMatrixOf& A, const SearchRange& range);

/// The sample between two others, at t = 0 ... 1 from the first to the second.
StabilitySample sample_between(const StateMatrixOf& A, const StabilitySample& low,
                               const StabilitySample& high, double t);

}  // namespace chladni::squeal
