#pragma once

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// A block X = Q R + rest with Q^T M Q = I, computed from its Gram matrix X^T M X alone.
struct Orthonormalisation {
  Eigen::MatrixXd to_Q;      ///< [n x r]: Q = X to_Q; longest direction first
  Eigen::MatrixXd R;         ///< [r x n]
  Eigen::MatrixXd left_out;  ///< [n - r x n]: the rest in orthonormal directions
  /// length of the shortest direction kept, with columns divided by their sizes
  double shortest;
  double condition;                 ///< ratio of the longest to the shortest direction kept
  double least_square;              ///< the smallest eigenvalue of G with columns divided by sizes
  Eigen::MatrixXd least_direction;  ///< [n x 1]: X least_direction has that square of a length
};

/// Keeps the directions whose length, with columns divided by their `sizes`, exceeds `least`. Each
/// column has its own size, so that a long one does not hide a short one.
/// @param G      X^T M X [n x n]
/// @param sizes  [n] length to which round-off in each column is relative
/// @note   Collective: the first rank decides.
Orthonormalisation orthonormalisation(const Eigen::MatrixXd& G, const std::vector<double>& sizes,
                                      double least, MPI_Comm comm);

/// The lengths of the columns of A.
std::vector<double> column_lengths(const Eigen::MatrixXd& A);

}  // namespace chladni::linear
