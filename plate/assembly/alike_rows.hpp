#pragma once

#include <cstdint>
#include <vector>

#include "plate/assembly/block_rows.hpp"

namespace chladni::plate {

/// Entries of a block of n x n: bit n * i + j stands for entry (i, j).
using BlockEntries = std::uint64_t;

/// Adds entries so that rows of a node with much the same columns have the same. Some entries of K
/// vanish by the symmetry of an element; few as they are, without them most rows have columns of
/// their own, and sparse products and symbolic factorisation take each row by itself. Rows are
/// alike that share more than half of the columns of the longer one, not those of bending and of
/// motion in the plane, which may have a few entries in common that are hardly more than round-off.
/// Between two sets of them all entries are added where a block has more than half. A node where
/// that would add more than a twentieth keeps the rows that it has.
/// @param entries  [n_blocks] of the blocks of the pattern; symmetric over all ranks
/// @param room     entries that can be added to any block; symmetric, the same on all ranks
/// @note   Collective on `comm`.
void make_rows_alike(const BlockPattern& pattern, std::vector<BlockEntries>& entries,
                     BlockEntries room, MPI_Comm comm);

}  // namespace chladni::plate
