#pragma once

#include <petscsys.h>

/// What versions of PETSc and SLEPc from 3.18 on call differently.
namespace chladni::petsc {

/// As a number that is not given: PETSc chooses it.
#if PETSC_VERSION_LT(3, 22, 0)
inline constexpr int automatic = PETSC_DEFAULT;
#else
inline constexpr int automatic = PETSC_DETERMINE;
#endif

/// What the options of an object are read from, as its function has it as an argument.
#if PETSC_VERSION_LT(3, 23, 0)
using OptionItems = PetscOptionItems*;
#else
using OptionItems = PetscOptionItems;
#endif

}  // namespace chladni::petsc

#if PETSC_VERSION_LT(3, 20, 0)
#define PetscAssertPointer PetscValidPointer  // NOLINT(readability-identifier-naming)
#endif
