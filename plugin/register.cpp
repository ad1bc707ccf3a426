// What -dll_append finds in libchladni_petsc.so.
#include "linear/cholesky/cholesky_types.hpp"
#include "plugin/chladni_cms.h"
#include "plugin/guard.hpp"

extern "C" PETSC_VISIBILITY_PUBLIC PetscErrorCode PetscDLLibraryRegister_chladni_petsc();

/// Called by PETSc when a library is loaded; a wrong name would be passed over in silence.
PetscErrorCode PetscDLLibraryRegister_chladni_petsc()
{
  PetscFunctionBegin;
  PetscCall(CMSInitializePackage());
  PetscCall(CMSRegisterEPS());
  PetscCall(chladni::plugin::guarded(nullptr, __func__,
                                     [] { chladni::linear::register_cholesky_types(); }));
  PetscFunctionReturn(0);
}
