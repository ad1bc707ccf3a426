#pragma once

#include <petscmat.h>

#include <exception>
#include <new>

#include "linear/cholesky/cholesky_factor.hpp"

/// The functions that PETSc calls on our Cholesky factors.
namespace chladni::linear {

/// The C++ object inside one of our factors.
CholeskyFactor& factor_of(Mat F);

/// Runs C++ inside a callback of PETSc. An exception becomes a PETSc error, with the code of the
/// PETSc call that failed, if one did.
template <typename Work>
PetscErrorCode guarded(const Work& work)
{
  try {
    work();
  } catch (const petsc::Failure& failure) {
    return PetscError(PETSC_COMM_SELF, __LINE__, PETSC_FUNCTION_NAME, __FILE__, failure.code,
                      PETSC_ERROR_REPEAT, " ");
  } catch (const std::bad_alloc&) {
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_MEM, "not enough memory for the factor");
  } catch (const std::exception& error) {
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", error.what());
  }
  return 0;
}

/// MatSolve: x = A^-1 b.
PetscErrorCode solve_vector(Mat F, Vec b, Vec x);
/// MatMatSolve: X = A^-1 B; X may be B.
PetscErrorCode solve_block(Mat F, Mat B, Mat X);
/// MatMatTransposeSolve: X = A^-1 B; the rows of the sparse B_t are the columns of B.
PetscErrorCode solve_sparse(Mat F, Mat B_t, Mat X);

}  // namespace chladni::linear
