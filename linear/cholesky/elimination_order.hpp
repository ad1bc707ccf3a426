#pragma once

#include <mpi.h>

#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/matrix_graph.hpp"

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

/// A nested dissection that the ranks make together. The first rank of a group finds a separator of
/// the group's vertices by METIS, which is eliminated last; each half of the group goes on with one
/// of the parts, and single ranks with METIS_NodeND. The longest way is that of the separators of
/// the whole graph, of half of it, and so on, of a rank's share beside them.
/// @param graph    in both directions, the same on all ranks
/// @param weights  [n_vertices] rows of each vertex
/// @return [n_vertices] the place of each vertex, on rank 0; empty on the others, and on all where
///         METIS fails. It depends on the number of ranks.
/// @note   Collective.
/// Source: Karypis and Kumar, J. Parallel Distrib. Comput. 48 (1998) 71.
std::vector<int> shared_dissection(const Adjacency& graph, const std::vector<int>& weights,
                                   MPI_Comm comm);

/// An order of elimination that keeps a known order of some rows: each other row comes right behind
/// the last of those that it has an entry with, or at the end where it has none. Nodes that were
/// left out of a nested dissection come to where it would have had them.
/// @param A      [n x n] AIJ, symmetric
/// @param known  [n] place of each row in the known order, -1 for other rows; the same on all ranks
/// @return [n] place of each row, from 0, on all ranks
/// @note   Collective on the communicator of A.
std::vector<int> extended_order(Mat A, const std::vector<int>& known);

}  // namespace chladni::linear
