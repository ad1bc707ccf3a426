#pragma once

#include <vector>

#include "common/petsc.hpp"
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

/// sum_j M_jj x_j^2 of each column x of X, to which the round-off of x^T M x is relative.
/// @note   Collective.
std::vector<double> diagonal_terms(Mat X, Mat M);

/// The columns x of X with x^T M x above its round-off, which are not in the null space of M.
/// @note   Collective.
petsc::Matrix columns_with_mass(Mat X, Mat MX, Mat M);

/// Scales the columns of X to unit length in M; columns without length become zero.
/// @note   Collective.
void normalise_columns(Mat X, Mat MX);

/// Fills a dense matrix with pseudo-random numbers in (-1, 1). They depend only on the global row
/// and on the number of the column, counted from `first_number`, and are the same for any number of
/// ranks.
void fill_with_random_numbers(Mat block, PetscInt first_number);

}  // namespace chladni::linear
