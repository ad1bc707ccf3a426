#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// The rows of this rank that are ordered, ascending, and the number of the block of each, counted
/// on this rank.
struct OwnBlocks {
  std::vector<PetscInt> rows;
  std::vector<int> block;
  int n_blocks() const { return block.empty() ? 0 : block.back() + 1; }
};

/// Blocks of A's block size or, without one, of consecutive rows of equal pattern.
/// @param rows  of A, ascending, on the rank that owns them; null: all
OwnBlocks own_blocks(Mat A, IS rows);

constexpr int left_out = -1;

/// Number of the block of each row of A, or `left_out`, on all ranks.
/// @note   Collective.
std::vector<int> block_of_rows(Mat A, const OwnBlocks& own);

/// Adjacency of the blocks of this rank without themselves: length of each list, then the lists.
struct BlockGraph {
  std::vector<int> degrees;
  std::vector<int> neighbours;
};

/// @param block_of  [rows of A] as `block_of_rows` gives it
BlockGraph own_graph(Mat A, const OwnBlocks& own, const std::vector<int>& block_of);

/// Blocks of this rank with the same neighbours, each counted among its own, become one: they are
/// eliminated together in any case. Of cubic quadrilaterals four of nine are left.
/// METIS_NodeND does that by itself, but the graph that ranks send each other is a fifth then.
/// @param graph     of the blocks of this rank; afterwards of those that are left
/// @param block_of  [rows of A] numbers of the blocks, which become those of the ones left
/// @note   Collective.
void merge_alike(BlockGraph& graph, std::vector<int>& block_of, MPI_Comm comm);

}  // namespace chladni::linear
