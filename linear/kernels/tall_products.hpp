#pragma once

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// The rows of this rank of some vectors, stored by columns.
struct LongColumns {
  const double* values;
  std::ptrdiff_t leading_dimension;
  PetscInt n_rows;
  PetscInt n_columns;
};

/// X^T Y of the rows of this rank, for long columns X and few Y. X is read once and, from six
/// columns on, not copied, as it would be by a general matrix product.
Eigen::MatrixXd tall_inner_product(const LongColumns& X, const LongColumns& Y);

/// Y <- Y - X S for few long columns Y.
void subtract_tall_product(const LongColumns& X, const Eigen::MatrixXd& S, double* Y,
                           std::ptrdiff_t leading_dimension);

/// Y <- X S for few long columns Y, which X does not share.
void tall_product(const LongColumns& X, const Eigen::MatrixXd& S, double* Y,
                  std::ptrdiff_t leading_dimension);

}  // namespace chladni::linear
