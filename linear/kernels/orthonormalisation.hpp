#pragma once

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// A block X as X = Q R + rest with Q^T M Q = I, from its Gram matrix X^T M X alone.
struct Orthonormalisation {
  Eigen::MatrixXd to_Q;      ///< [n x r]: Q = X to_Q; the longest direction first
  Eigen::MatrixXd R;         ///< [r x n]
  Eigen::MatrixXd left_out;  ///< [n - r x n]: the rest in orthonormal directions
  double shortest;  ///< length of the last direction kept, the columns being divided by their sizes
  double condition;  ///< ratio of the longest to the shortest direction kept
};

/// Keeps the directions whose length, the columns being divided by their `sizes`, exceeds `least`.
/// Each column has a size of its own, so that a long one does not hide a short one.
/// @param G  X^T M X [n x n]
/// @param sizes  [n] what round-off in each column is relative to
/// @note   Collective: the first rank decides.
Orthonormalisation orthonormalisation(const Eigen::MatrixXd& G, const std::vector<double>& sizes,
                                      double least, MPI_Comm comm);

/// The lengths of the columns of A.
std::vector<double> column_lengths(const Eigen::MatrixXd& A);

}  // namespace chladni::linear
