#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// sum_j M_jj x_j^2 of each column x of X: what the round-off in x^T M x is relative to.
/// @note   Collective.
std::vector<double> diagonal_terms(Mat X, Mat M);

/// The columns x of X with x^T M x above round-off of its terms: those that are not in the null
/// space of M.
/// @note   Collective.
petsc::Matrix columns_with_mass(Mat X, Mat MX, Mat M);

/// X <- X with columns of unit length in M; those without any become zero.
/// @note   Collective.
void normalise_columns(Mat X, Mat MX);

}  // namespace chladni::linear
