#pragma once

#include <petscsys.h>

#include <exception>
#include <new>

#include "common/error.hpp"

namespace chladni::reduce::plugin {

/// Runs work() and turns exceptions into PETSc errors: none crosses into C. What the library throws
/// is thrown on all ranks alike and reported once; memory runs out on one.
template <class Work>
PetscErrorCode guarded(PetscObject object, const char* function, const Work& work) noexcept
{
  const auto report = [&](MPI_Comm comm, PetscErrorCode code, const char* text) {
    return PetscError(comm, __LINE__, function, __FILE__, code, PETSC_ERROR_INITIAL, "%s", text);
  };
  try {
    work();
    return 0;
  } catch (const std::bad_alloc&) {
    return report(PETSC_COMM_SELF, PETSC_ERR_MEM,
                  "not enough memory; use more ranks on more machines or fewer modes");
  } catch (const Error& error) {
    return report(PetscObjectComm(object), PETSC_ERR_USER_INPUT, error.what());
  } catch (const std::exception& error) {
    return report(PetscObjectComm(object), PETSC_ERR_LIB, error.what());
  } catch (...) {
    return report(PETSC_COMM_SELF, PETSC_ERR_LIB, "unknown C++ exception");
  }
}

}  // namespace chladni::reduce::plugin
