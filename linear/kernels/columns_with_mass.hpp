#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// sum_j M_jj x_j^2 of each column x of X, to which the round-off of x^T M x is relative.
/// @note   Collective.
std::vector<double> diagonal_terms(Mat X, Mat M);

/// The columns x of X with x^T M x above its round-off, which are not in the null space of M.
/// @note   Collective.
petsc::Matrix columns_with_mass(Mat X, Mat MX, Mat M);

/// Scales the columns of X to unit length in M; columns without length become zero.
/// @note   Collective.
void normalise_columns(Mat X, Mat MX);

}  // namespace chladni::linear
