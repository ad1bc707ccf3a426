#pragma once

#include <Eigen/Core>
#include <vector>

#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {

/// The spectrum of A at one value of the parameter.
struct StabilitySample {
  double value;
  Eigen::VectorXcd lambda;  ///< one of each mode, in the order of the branches
  bool unstable;

  double growth() const { return lambda.real().maxCoeff(); }
};

/// Whether x' = A x grows faster than rounding can make of a neutral motion; see stability_over.
bool is_unstable(const Eigen::MatrixXd& A);

/// Growth that rounding can make of a neutral motion whose eigenvalue has the condition 1, 1/s.
double rounding_of(const Eigen::VectorXcd& lambda);

/// Samples at equal distances, branches followed by extrapolation.
std::vector<StabilitySample> scan(const StateMatrixOf& A, const SearchRange& range);

/// The sample at a value between two others, t = 0 at the first.
StabilitySample sample_between(const StateMatrixOf& A, const StabilitySample& low,
                               const StabilitySample& high, double t);

}  // namespace chladni::squeal
