#pragma once

#include <algorithm>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear::testing {

/// A free chain of n unit masses and n - 1 unit springs.
struct Chain {
  petsc::Matrix K, M;
};

inline petsc::Matrix empty(PetscInt n)
{
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 3, nullptr, 3,
                            nullptr, A.put()));
  return A;
}

inline void finish(Mat A)
{
  petsc::check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
}

inline Chain free_chain(PetscInt n)
{
  Chain chain{.K = empty(n), .M = empty(n)};
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(chain.K, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    const double springs = (i > 0) + (i + 1 < n);
    petsc::check(MatSetValue(chain.K, i, i, springs, INSERT_VALUES));
    if (i > 0) petsc::check(MatSetValue(chain.K, i, i - 1, -1.0, INSERT_VALUES));
    if (i + 1 < n) petsc::check(MatSetValue(chain.K, i, i + 1, -1.0, INSERT_VALUES));
    petsc::check(MatSetValue(chain.M, i, i, 1.0, INSERT_VALUES));
  }
  finish(chain.K);
  finish(chain.M);
  return chain;
}

/// Each rank gives those masters that it owns.
inline petsc::IndexSet master_set(Mat K, const std::vector<PetscInt>& masters)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(K, &first, &last));
  std::vector<PetscInt> own;
  std::ranges::copy_if(masters, std::back_inserter(own),
                       [&](PetscInt i) { return i >= first && i < last; });
  petsc::IndexSet set;
  petsc::check(ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(own.size()), own.data(),
                               PETSC_COPY_VALUES, set.put()));
  return set;
}

}  // namespace chladni::linear::testing
