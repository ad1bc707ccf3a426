#pragma once

#include "common/petsc.hpp"

namespace chladni::linear {

/// Fills a dense matrix with pseudo-random numbers in (-1, 1). They depend only on the global row
/// and on the number of the column, counted from `first_number`, and are the same for any number of
/// ranks.
void fill_with_random_numbers(Mat block, PetscInt first_number);

}  // namespace chladni::linear
