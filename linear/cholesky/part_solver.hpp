#pragma once

#include <functional>

#include "common/petsc.hpp"
#include "linear/cholesky/inverse_form.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

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
