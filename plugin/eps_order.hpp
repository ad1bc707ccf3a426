#pragma once

#include <slepceps.h>

namespace chladni::plugin {

/// Which eigenvalues come first, by what the user set; SLEPc's own is not visible to other
/// libraries.
PetscErrorCode set_up_sort(EPS eps);

/// Order of two eigenvalues of the transformed problem, back-transformed, as the user wants them.
/// @throws chladni::petsc::Failure
bool comes_before(EPS eps, PetscScalar a, PetscScalar b);

}  // namespace chladni::plugin
