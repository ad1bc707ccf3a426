#pragma once

#include <slepceps.h>

#include "linear/lanczos/block_iteration.hpp"

/// The operators that block Lanczos needs from an EPS, after EPSSetUp.
namespace chladni::plugin {

/// The matrix B of the inner product; the identity for a standard problem.
petsc::Matrix inner_product_matrix(EPS eps);

/// True if the spectral transformation is shift-and-invert.
bool inverts(EPS eps);

/// The operator of the spectral transformation: for shift-and-invert (A - sigma B)^-1 B, by block
/// solves with its linear solver; any other is applied column by column.
/// @throws chladni::Error when A - sigma B has no factor.
linear::BlockOperator operator_of(EPS eps);

}  // namespace chladni::plugin
