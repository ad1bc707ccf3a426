#pragma once

#include <vector>

#include "reduce/dense.hpp"

namespace chladni::reduce {

/// Eigenvalues, ascending, and orthonormal eigenvectors of a small symmetric matrix (LAPACK
/// dsyevd).
struct SymmetricEigen {
  std::vector<double> values;
  SmallMatrix vectors;
};
SymmetricEigen symmetric_eigen(SmallMatrix A);

}  // namespace chladni::reduce
