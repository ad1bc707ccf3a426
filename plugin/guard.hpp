#pragma once

#include <petscsys.h>

#include <cstdio>
#include <exception>
#include <new>

#include "common/petsc.hpp"

namespace chladni::plugin {

/// Something that the user's program does inside of a call failed with this PETSc error.
class UsersFailure : public Error {
 public:
  UsersFailure(PetscErrorCode error_code, const std::string& text) : Error(text), code(error_code)
  {}
  PetscErrorCode code;
};

/// Memory that runs out on one rank is nothing that the others know of: they wait for this one in
/// the middle of their work, and only the end of all of them keeps them from waiting for ever. The
/// last words stand here, since an error handler may keep PETSc's report to itself.
inline PetscErrorCode without_memory(MPI_Comm comm)
{
  if (petsc::size(comm) == 1) return PETSC_ERR_MEM;
  std::fprintf(stderr,
               "chladni: rank %d has not enough memory, so all ranks end; use more machines or ask "
               "for fewer modes\n",
               petsc::rank(comm));
  MPI_Abort(comm, PETSC_ERR_MEM);
  return PETSC_ERR_MEM;
}

/// Runs work() and turns exceptions into PETSc errors: none crosses into C. What the library throws
/// is thrown on all ranks alike and reported once; memory runs out on one, which ends them all.
template <class Work>
PetscErrorCode guarded(PetscObject object, const char* function, const Work& work) noexcept
{
  const MPI_Comm comm = object ? PetscObjectComm(object) : PETSC_COMM_SELF;
  const auto report = [&](MPI_Comm where, PetscErrorCode code, const char* text) {
    return PetscError(where, __LINE__, function, __FILE__, code, PETSC_ERROR_INITIAL, "%s", text);
  };
  try {
    work();
    return 0;
  } catch (const petsc::Failure& failure) {  // PETSc has reported it already
    const PetscErrorCode code =
        PetscError(comm, __LINE__, function, __FILE__, failure.code, PETSC_ERROR_REPEAT, " ");
    return code == PETSC_ERR_MEM ? without_memory(comm) : code;
  } catch (const std::bad_alloc&) {
    report(PETSC_COMM_SELF, PETSC_ERR_MEM,
           "not enough memory; use more ranks on more machines or fewer modes");
    return without_memory(comm);
  } catch (const UsersFailure& failure) {
    return report(comm, failure.code, failure.what());
  } catch (const Error& error) {
    return report(comm, PETSC_ERR_USER_INPUT, error.what());
  } catch (const std::exception& error) {
    return report(comm, PETSC_ERR_LIB, error.what());
  } catch (...) {
    return report(PETSC_COMM_SELF, PETSC_ERR_LIB, "unknown C++ exception");
  }
}

}  // namespace chladni::plugin
