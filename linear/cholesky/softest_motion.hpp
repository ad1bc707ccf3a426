#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// The motion z that a symmetric positive semidefinite A resists least.
struct SoftestMotion {
  double stiffness;  ///< z^T A z / z^T diag(A) z; of the size of round-off if nothing holds z
  PetscInt row;      ///< row in which z is largest
};

/// Finds the softest motion by two inverse iterations with a few deterministic vectors.
/// @param factor  of A, or of A with a slightly larger diagonal
/// @note   Collective; two block solves.
SoftestMotion softest_motion(Mat factor, Mat A);

}  // namespace chladni::linear
