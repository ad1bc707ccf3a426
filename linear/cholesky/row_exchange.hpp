#pragma once

#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// The destinations of the rows of a solution that MUMPS leaves distributed.
struct RowExchange {
  std::vector<int> send_rows;  ///< rows of MUMPS' solution, ordered by owner
  std::vector<int> send_counts, receive_counts;
  std::vector<int> receive_rows;  ///< own rows, ordered by sender
};

/// Plans the exchange of rows.
/// @param rows        [n] global rows, from 1, of the solution that MUMPS left on this rank
/// @param first_rows  [n_ranks + 1] first row of each rank
/// @note   Collective on `comm`.
RowExchange plan_exchange(const std::vector<int>& rows, const std::vector<PetscInt>& first_rows,
                          MPI_Comm comm);

/// Moves columns that MUMPS left distributed to the ranks that own their rows.
/// @note   Collective on `comm`.
void exchange_rows(const RowExchange& plan, const std::vector<double>& from,
                   PetscInt from_leading_dimension, LocalColumns to, MPI_Comm comm);

}  // namespace chladni::linear
