#pragma once

#include <petscsys.h>

#include <cstdio>
#include <exception>
#include <new>

#include "common/petsc.hpp"

namespace chladni::plugin {

/// An error returned by a function of the user's program that was called from a solution.
class UsersFailure : public Error {
 public:
  UsersFailure(PetscErrorCode error_code, const std::string& text) : Error(text), code(error_code)
  {}
  PetscErrorCode code;
};

/// Ends all ranks after memory ran out on this one, since the others would wait for it forever. On
/// a single rank returns PETSC_ERR_MEM instead. Prints its own message, because an error handler
/// may suppress PETSc's.
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

/// Runs work() and turns exceptions into PETSc errors, so that none reaches C. Errors of the
/// library are thrown on all ranks and reported once; memory that runs out on one rank ends all
/// ranks.
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
