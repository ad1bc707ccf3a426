#pragma once

#include <slepceps.h>

#include "linear/lanczos/block_iteration.hpp"

/// The operators that block Lanczos needs from an EPS, after EPSSetUp.

namespace chladni::plugin {

/// The matrix B of the inner product; the identity for a standard problem.
petsc::Matrix inner_product_matrix(EPS eps);

/// The matrices of the problem as they are during a solve; B is null for a standard one.
struct ProblemMatrices {
  Mat A, B;
};
ProblemMatrices problem_matrices(EPS eps);

/// The matrices of the problem itself as plain AIJ; B is the identity for a standard one.
petsc::Matrix stiffness_of(EPS eps);
petsc::Matrix mass_of(EPS eps);

/// The s of A - s B that -st_matmode inplace has put in the place of A; 0 elsewhere.
double shift_in_place(EPS eps);

/// True if the spectral transformation is shift-and-invert.
bool inverts(EPS eps);

/// True if the basis has the inner product of the transformation, not one that was set by
/// BVSetMatrix after EPSSetUp.
bool has_own_inner_product(EPS eps);

/// True if the operator is applied by a factor, to round-off, or without any solver; false if a
/// solver inside iterates.
bool is_direct(EPS eps);

/// The vectors of EPSSetDeflationSpace, orthonormal in B; empty without any.
petsc::Matrix deflation_space(EPS eps);

/// The operator of the spectral transformation: for shift-and-invert (A - sigma B)^-1 B, by block
/// solves with its linear solver; any other is applied column by column. A deflation space C is
/// taken out of what it returns.
/// @throws chladni::Error when A - sigma B has no factor.
linear::BlockOperator operator_of(EPS eps, Mat C);

/// Sets the order of eigenvalues that the user asked for. SLEPc's function for it is not visible to
/// other libraries.
PetscErrorCode set_up_sort(EPS eps);

/// True if eigenvalue `a` comes before `b` in the order that the user wants. Both are eigenvalues
/// of the transformed problem and are transformed back first.
/// @throws chladni::petsc::Failure
bool comes_before(EPS eps, PetscScalar a, PetscScalar b);

}  // namespace chladni::plugin
