#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// What the ranks have at rows that may be those of others.
/// @param rows  global numbers
/// @param own   a value for each row of this rank
/// @return one for each of `rows`
/// @note   Collective.
std::vector<double> values_at(const std::vector<PetscInt>& rows, std::vector<double> own,
                              MPI_Comm comm);

}  // namespace chladni::linear
