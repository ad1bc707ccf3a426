#pragma once

#include <slepceps.h>

namespace chladni::plugin {

/// The number of leading pairs, of the nconv pairs of a solved EPS, that satisfy A x = lambda B x.
/// The residual is compared with 100 times the tolerance, at least 1e-4, times (lambda - sigma) B
/// x, and with the round-off of A x, in a norm that does not depend on units. A residual above 100
/// times the tolerance becomes the error estimate of its pair.
/// @param X  eigenvectors [n x nconv] dense
/// @note   Collective.
PetscInt n_true_pairs(EPS eps, Mat X);

}  // namespace chladni::plugin
