#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/parted_form.hpp"

namespace chladni::linear {

/// A dense matrix of many columns that is not stored as one.
struct ColumnSource {
  PetscInt n_columns;
  /// Writes this rank's rows of a column.
  std::function<void(PetscInt column, std::span<double> rows)> write;
};

struct SparseForm {
  Mat A;
  FormSymmetry symmetry;
};

/// T^T A T of several matrices that have entries in some of the components of a node only, as those
/// that tell of one direction have: the rows of each component are copied once for all of them,
/// without the columns that are zero there.
/// @param T      its rows are distributed as those of each A
/// @param forms  AIJ of the same layout; their block size is the number of components
/// @return on every rank; symmetric to the last bit where A is said to be
/// @note   Collective.
std::vector<Eigen::MatrixXd> component_forms(const ColumnSource& T,
                                             std::span<const SparseForm> forms);

}  // namespace chladni::linear
