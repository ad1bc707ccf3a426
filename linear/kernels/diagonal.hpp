#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// The diagonal of a square matrix. PETSc 3.18 looks through half of each row for it.
/// @note   Collective.
petsc::Vector diagonal(Mat A);

}  // namespace chladni::linear
