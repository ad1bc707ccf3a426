#pragma once

#include <slepceps.h>

namespace chladni::plugin {

/// Sets the order of eigenvalues that the user asked for. SLEPc's function for it is not visible to
/// other libraries.
PetscErrorCode set_up_sort(EPS eps);

/// True if eigenvalue `a` comes before `b` in the order that the user wants. Both are eigenvalues
/// of the transformed problem and are transformed back first.
/// @throws chladni::petsc::Failure
bool comes_before(EPS eps, PetscScalar a, PetscScalar b);

}  // namespace chladni::plugin
