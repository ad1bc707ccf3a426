#pragma once

#include <slepceps.h>

#include "linear/lanczos/block_iteration.hpp"

/// What block Lanczos needs of the problem of an EPS, after EPSSetUp.
namespace chladni::plugin {

/// B of the inner product; the identity for a standard problem.
petsc::Matrix inner_product_matrix(EPS eps);

/// The spectral transformation is shift-and-invert.
bool inverts(EPS eps);

/// (A - sigma B)^-1 B by block solves with the solver of the spectral transformation, or what the
/// transformation is.
linear::BlockOperator operator_of(EPS eps);

}  // namespace chladni::plugin
