#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// Makes modes zero in those decoupled parts (decoupled_rows.hpp) of K and M where an eigen-solver
/// has left round-off of them: less than 1e-20 of x^T M x. Matrices projected on such modes fall
/// into parts as K and M do. A mode that is mixed from parts with a common eigenvalue stays so.
/// @param X  dense, with the rows of M
/// @note   Collective.
void clear_part_traces(Mat K, Mat M, Mat X);

}  // namespace chladni::linear
