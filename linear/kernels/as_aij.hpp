#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// A matrix as plain AIJ: a reference if it is plain AIJ, else a converted copy. PETSc's variants
/// of AIJ (aijperm, aijsell) and its block formats store their entries elsewhere.
/// @note   Collective.
petsc::Matrix as_aij(Mat A);

}  // namespace chladni::linear
