#pragma once

#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/cholesky_factor.hpp"

namespace chladni::linear {

/// Where the rows of a solution that MUMPS leaves distributed go to.
struct RowExchange {
  std::vector<int> send_rows;  ///< rows of MUMPS' solution, by rank that owns them
  std::vector<int> send_counts, receive_counts;
  std::vector<int> receive_rows;  ///< own rows, by rank that sends them
};

/// @param rows        [n] global rows from 1 of what MUMPS left on this rank
/// @param first_rows  [n_ranks + 1] of those that the ranks own
/// @note  Collective on `comm`.
RowExchange plan_exchange(const std::vector<int>& rows, const std::vector<PetscInt>& first_rows,
                          MPI_Comm comm);

/// Moves columns that MUMPS left distributed to the ranks that own their rows.
/// @note  Collective on `comm`.
void exchange_rows(const RowExchange& plan, const std::vector<double>& from,
                   PetscInt from_leading_dimension, LocalColumns to, MPI_Comm comm);

}  // namespace chladni::linear
