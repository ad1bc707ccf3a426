#pragma once

#include <petsc/private/petscimpl.h>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Which matrix with which values.
struct MatrixState {
  PetscObjectId id = 0;
  PetscObjectState state = 0;
  bool operator==(const MatrixState&) const = default;
};

inline MatrixState state_of(Mat A)
{
  MatrixState now;
  petsc::check(PetscObjectGetId(reinterpret_cast<PetscObject>(A), &now.id));
  petsc::check(PetscObjectStateGet(reinterpret_cast<PetscObject>(A), &now.state));
  return now;
}

}  // namespace chladni::linear
