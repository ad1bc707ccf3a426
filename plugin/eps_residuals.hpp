#pragma once

#include <slepceps.h>

namespace chladni::plugin {

/// How many of the first nconv pairs of a solved EPS satisfy A x = lambda B x. The residual is
/// compared with the tolerance times (lambda - sigma) B x, and with the round-off of A x, in a norm
/// that does not depend on units; it becomes the error estimate where it is a hundred times the
/// tolerance.
/// @param X  eigenvectors [n x nconv] dense
/// @note   Collective.
PetscInt n_true_pairs(EPS eps, Mat X);

}  // namespace chladni::plugin
