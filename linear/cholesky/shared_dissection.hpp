#pragma once

#include <mpi.h>

#include <vector>

#include "linear/kernels/adjacency.hpp"

namespace chladni::linear {

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

}  // namespace chladni::linear
