#pragma once

#include <functional>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

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

/// True if a factor can solve for rows that are coupled to no others without processing the rest.
bool solves_for_parts(Mat factor);

/// True if a factor made with these options can solve for parts.
bool will_solve_for_parts(const OptionSource& source);

/// A function X <- A_pp^-1 B, where p are the rows of a part; B and X are dense with these rows
/// alone.
/// @param factor  of A; must outlive the returned function
/// @param rows    global rows, ascending on each rank, which owns them
/// @note   Collective, as is the returned function.
/// @throws chladni::Error when other rows are coupled to these, or the factor does not solve for
///         parts.
std::function<void(Mat B, Mat X)> part_solver(Mat factor, IS rows);

/// A function that makes the form B^T A_pp^-1 B of a part; B has the rows of the part alone. The
/// rest as `part_solver`.
std::function<InverseForm(petsc::Matrix B)> part_form(Mat factor, IS rows);

}  // namespace chladni::linear
