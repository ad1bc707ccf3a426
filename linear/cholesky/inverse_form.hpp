#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// Dense matrices [n x k] for right-hand sides B, with left^T right = B^T A^-1 B.
struct InverseForm {
  petsc::Matrix left;
  petsc::Matrix forces;  ///< B; empty if left equals right

  Mat right() const { return forces ? Mat(forces) : Mat(left); }
};

/// True for our own factor of a positive definite A: half a solution makes the form.
bool halves(Mat factor);

/// The form B^T A^-1 B. Where half a solution is enough, left
/// = right = D^(-1/2) L^-1 B, stored in the place of B. With any other factor left = A^-1 B and
/// right = B.
/// @param factor  of A
/// @note   Collective.
InverseForm inverse_form(Mat factor, petsc::Matrix B);

}  // namespace chladni::linear
