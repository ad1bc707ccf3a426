#pragma once

#include <functional>

#include "common/petsc.hpp"
#include "linear/solver_options.hpp"

namespace chladni::linear {

/// Whether a factor solves for rows that are coupled to no others without passing over the rest.
bool solves_for_parts(Mat factor);

/// Whether a factor made by these options will.
bool will_solve_for_parts(const OptionSource& source);

/// X <- A_pp^-1 B, where p are the rows of a part; dense B and X with these rows alone.
/// @param factor  of A, which outlives what is returned
/// @param rows    global; those of each rank ascend, and on the rank that owns them
/// @throws chladni::Error when others are coupled to them, or the factor does not solve for parts.
/// @note   Collective, as the function is.
std::function<void(Mat B, Mat X)> part_solver(Mat factor, IS rows);

}  // namespace chladni::linear
