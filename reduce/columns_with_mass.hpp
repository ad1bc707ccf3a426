#pragma once

#include "common/petsc.hpp"

namespace chladni::reduce {

/// The columns x of X with x^T M x above round-off of its terms: those that are not in the null
/// space of M.
/// @note   Collective.
petsc::Matrix columns_with_mass(Mat X, Mat MX, Mat M);

/// X <- X with columns of unit length in M; those without any become zero.
/// @note   Collective.
void normalise_columns(Mat X, Mat MX);

}  // namespace chladni::reduce
