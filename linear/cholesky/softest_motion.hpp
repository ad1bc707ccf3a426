#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// The motion z that a symmetric positive semidefinite A resists least.
struct SoftestMotion {
  double stiffness;  ///< z^T A z / z^T diag(A) z; round-off where nothing holds it
  PetscInt row;      ///< where it is largest
};

/// By two inverse iterations with a few deterministic vectors.
/// @param factor  of A, or of A with a somewhat larger diagonal
/// @note   Collective; two block solves.
SoftestMotion softest_motion(Mat factor, Mat A);

}  // namespace chladni::linear
