#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// A fill-reducing nested dissection of a symmetric sparse matrix by METIS. Rows that belong
/// together get neighbouring numbers: those of a block of A's block size or, without one,
/// consecutive rows of equal pattern. The graph for METIS is that of these blocks, 36 times smaller
/// than the matrix of a shell. An entry on one side of the diagonal counts on both, since a pattern
/// need not be symmetric where zeros are stored. Several ranks dissect a large graph together
/// (`shared_dissection`); the order then depends on their number.
/// @param A  [n x n] AIJ, symmetric
/// @return on rank 0 [n], the place of each row in the elimination, from 1 (MUMPS' PERM_IN); empty
///         on the other ranks
/// @note   Collective on the communicator of A; the graph of the blocks is gathered on rank 0.
/// @throws chladni::Error on all ranks when METIS fails, or when the graph has more edges than
///         METIS can count.
/// Source: Karypis and Kumar, SIAM J. Sci. Comput. 20 (1998) 359.
std::vector<int> elimination_order(Mat A);

/// The same of some rows of A, as if the others were not there.
/// @param rows  ascending, on the rank that owns them
/// @return on rank 0 the place of each of these rows among them, from 1, in the order of the ranks
std::vector<int> elimination_order(Mat A, IS rows);

/// Lets `elimination_order(A)` give an order that is known already.
/// @param places  as it returns them
void keep_order(Mat A, std::vector<int> places);

}  // namespace chladni::linear
