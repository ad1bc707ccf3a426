#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// A matrix as plain AIJ: a reference if it is plain AIJ, else a converted copy. PETSc's variants
/// of AIJ (aijperm, aijsell) and its block formats store their entries elsewhere.
/// @note   Collective.
petsc::Matrix as_aij(Mat A);

/// A plain AIJ matrix in whose rows columns ascend: the same one if they do, else a copy, in which
/// what stands twice is added up, as MatMult does. MatCreateSeqAIJWithArrays takes rows as they
/// are.
/// @note   Collective.
petsc::Matrix with_ascending_rows(petsc::Matrix A);

}  // namespace chladni::linear
