#pragma once

#include <string>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Some rows and columns of a sparse matrix in any order, each on the rank that has it already.
/// PETSc 3.18's MatCreateSubMatrix wants those of several ranks in ascending order.
/// @param A        AIJ; any other type is converted
/// @param rows     global rows, on the rank that owns them
/// @param columns  global columns, on the rank that owns them; not twice the same
/// @param folder   for the arrays, in a file of each rank, where they take no memory while nobody
///                 multiplies by them; empty: they are in memory
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix own_submatrix(Mat A, IS rows, IS columns, const std::string& folder = {});

}  // namespace chladni::linear
