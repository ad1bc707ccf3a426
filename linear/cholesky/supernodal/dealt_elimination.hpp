#pragma once

#include <mpi.h>

#include <cstddef>

#include "linear/cholesky/supernodal/dealt_rows.hpp"

namespace chladni::linear {

/// The rows of a front that were dealt to a rank. All matrices are stored by columns.
struct DealtFront {
  DealtRows rows;
  int place;          ///< of this rank in the group
  MPI_Comm comm;      ///< of the group
  double* L;          ///< [own rows x n_columns] lower triangle of A; becomes L, with D
  double* rest;       ///< [own rows below x n_below] lower triangle of what is left for the parent
  double* triangle;   ///< [n_columns x n_columns] becomes the L of the columns, on all ranks
  double* D;          ///< [n_columns] becomes D, on all ranks
  double* workspace;  ///< of `size_of_workspace`

  int n_own() const { return rows.count(place, 0, rows.n_rows()); }
  int n_own_pivots() const { return rows.count(place, 0, rows.n_columns()); }
};

std::size_t size_of_workspace(const DealtRows& rows, int place);

/// A = L D L^T for the columns, and rest <- rest - L_21 D L_21^T, without pivoting. Groups of
/// columns are eliminated by all ranks, the rows under them by the ranks that have them. It goes on
/// where a pivot fails: ranks on different processors may not agree about that.
/// @return the number of negative pivots; -1 at a pivot that is zero or NaN
/// @note   Collective over the group.
int eliminate_dealt(const DealtFront& front);

/// Replaces the own rows of L by those of L_11^-1 and L_21 L_11^-1.
void divide_by_triangle(const DealtFront& front);

}  // namespace chladni::linear
