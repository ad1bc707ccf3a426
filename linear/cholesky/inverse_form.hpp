#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// Dense matrices [n x k] of some forces B with left^T right = B^T A^-1 B.
struct InverseForm {
  petsc::Matrix left;
  petsc::Matrix forces;  ///< empty where left serves for both

  Mat right() const { return forces ? Mat(forces) : Mat(left); }
};

/// The form of A^-1 on the columns of B. The factor of our own of a positive definite A takes half
/// a solution for it, left = right = D^(-1/2) L^-1 B in the place of B; with any other factor
/// left = A^-1 B and right = B.
/// @param factor  of A
/// @note   Collective.
InverseForm inverse_form(Mat factor, petsc::Matrix B);

}  // namespace chladni::linear
