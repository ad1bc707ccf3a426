#pragma once

#include <memory>

#include "common/petsc.hpp"

namespace chladni::petsc {

/// Keeps something as long as a PETSc object lives, such as the arrays of a matrix that refers to
/// them.
/// @param name  of what is kept, one for each kind; replaces what was kept by this name
template <typename T>
void keep_with(PetscObject object, const char* name, std::unique_ptr<T> kept)
{
  PetscContainer container = nullptr;
  check(PetscContainerCreate(PetscObjectComm(object), &container));
  check(PetscContainerSetPointer(container, kept.release()));
  check(PetscContainerSetUserDestroy(container, [](void* attached) -> PetscErrorCode {
    delete static_cast<T*>(attached);
    return 0;
  }));
  check(PetscObjectCompose(object, name, reinterpret_cast<PetscObject>(container)));
  check(PetscContainerDestroy(&container));  // the object keeps it
}

/// What `keep_with` keeps by a name, or null.
template <typename T>
T* kept_with(PetscObject object, const char* name)
{
  PetscContainer container = nullptr;
  void* kept = nullptr;
  check(PetscObjectQuery(object, name, reinterpret_cast<PetscObject*>(&container)));
  if (container != nullptr) check(PetscContainerGetPointer(container, &kept));
  return static_cast<T*>(kept);
}

}  // namespace chladni::petsc
