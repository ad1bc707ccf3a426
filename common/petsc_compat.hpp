#pragma once

#include <petscsys.h>

/// Differences between the versions of PETSc and SLEPc from 3.18 on.
namespace chladni::petsc {

/// The value of a number that PETSc is to choose.
#if PETSC_VERSION_LT(3, 22, 0)
inline constexpr int automatic = PETSC_DEFAULT;
#else
inline constexpr int automatic = PETSC_DETERMINE;
#endif

/// The type of the argument from which an object's function reads its options.
#if PETSC_VERSION_LT(3, 23, 0)
using OptionItems = PetscOptionItems*;
#else
using OptionItems = PetscOptionItems;
#endif

}  // namespace chladni::petsc

#if PETSC_VERSION_LT(3, 20, 0)
#define PetscAssertPointer PetscValidPointer  // NOLINT(readability-identifier-naming)
#endif
