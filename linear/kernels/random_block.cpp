#include "linear/kernels/random_block.hpp"

#include <cstdint>

namespace chladni::linear {

namespace {

/// Deterministic numbers in (-1, 1) from the global row and the column (splitmix64).
double random_number(std::uint64_t row, std::uint64_t column)
{
  std::uint64_t z = row * 0x9E3779B97F4A7C15ULL + column * 0xD1B54A32D192ED03ULL + 1;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return 2.0 * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1.0;
}

}  // namespace

void fill_with_random_numbers(Mat block, PetscInt first_number)
{
  PetscScalar* values = nullptr;
  PetscInt first = 0, n_local = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(block, &first, nullptr));
  petsc::check(MatGetLocalSize(block, &n_local, nullptr));
  petsc::check(MatGetSize(block, nullptr, &n_columns));
  petsc::check(MatDenseGetArrayWrite(block, &values));
  for (PetscInt j = 0; j < n_columns; ++j)
    for (PetscInt i = 0; i < n_local; ++i)
      values[i + std::size_t(j) * n_local] = random_number(first + i, first_number + j);
  petsc::check(MatDenseRestoreArrayWrite(block, &values));
}

}  // namespace chladni::linear
