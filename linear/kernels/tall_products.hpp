#pragma once

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// Long columns, one after the other: the rows of this rank of some vectors.
struct LongColumns {
  const double* values;
  std::ptrdiff_t leading_dimension;
  PetscInt n_rows;
  PetscInt n_columns;
};

/// X^T Y of this rank for many long columns X and few Y: X is read once for eight columns of Y and
/// not packed, as a general matrix product would.
Eigen::MatrixXd tall_inner_product(const LongColumns& X, const LongColumns& Y);

/// Y <- Y - X S for few long columns Y.
void subtract_tall_product(const LongColumns& X, const Eigen::MatrixXd& S, double* Y,
                           std::ptrdiff_t leading_dimension);

}  // namespace chladni::linear
