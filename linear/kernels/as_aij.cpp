#include "linear/kernels/as_aij.hpp"

namespace chladni::linear {

petsc::Matrix as_aij(Mat A)
{
  const auto object = reinterpret_cast<PetscObject>(A);
  PetscBool is_plain = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompareAny(object, &is_plain, MATSEQAIJ, MATMPIAIJ, ""));
  if (is_plain) {
    petsc::check(PetscObjectReference(object));
    return petsc::Matrix(A);
  }
  petsc::Matrix copy;
  petsc::check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, copy.put()));
  return copy;
}

}  // namespace chladni::linear
