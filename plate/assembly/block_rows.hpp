#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::plate {

/// The n x n blocks in the rows of the nodes first, first + 1, ... of a square matrix, in CSR form.
struct BlockPattern {
  int n = 6;  ///< DOFs of each node
  PetscInt first = 0;
  std::vector<std::ptrdiff_t> start;  ///< [n_rows + 1] of each row in `column`
  std::vector<PetscInt> column;       ///< node numbers, ascending in each row
  std::vector<PetscInt> full = {};    ///< nodes that others follow, ascending: any entry may come

  PetscInt n_rows() const { return static_cast<PetscInt>(start.size()) - 1; }
};

/// @param n           DOFs of each node
/// @param neighbours  [n_rows] for each row the nodes that share an element with it, in any order
BlockPattern block_pattern(int n, PetscInt first, std::vector<std::vector<PetscInt>> neighbours);

/// Where the blocks of an element matrix stand among those of the pattern.
/// @param nodes  of the element, by number; the same may stand there twice
/// @return [n_nodes x n_nodes] by rows; -1 where the row is not in the pattern
std::vector<std::ptrdiff_t> block_places(const BlockPattern& pattern,
                                         std::span<const PetscInt> nodes);

/// Sums of element matrices over a pattern. Each entry adds in the order of the calls, whatever
/// rank the row is on. Of a block only the components are held that some element has, but of those
/// of full nodes: half of K and a sixth of M for plane shells, and memory that is touched for the
/// first time is what takes longest.
class BlockRows {
 public:
  explicit BlockRows(const BlockPattern& pattern) : pattern_(pattern) {}

  /// Adds the rows of `A_e` whose nodes are in the pattern.
  /// @param A_e     symmetric, or the transposed of what is added; n rows for each of its nodes
  /// @param places  block_places of its nodes
  void add(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places);

  /// The matrix without its zeros off the diagonal, of block size n; empties this one.
  /// @param negligible  entries with |A_ij| <= negligible sqrt |A_ii A_jj| are round-off and left
  ///                    out, on both sides of the diagonal where the sums are symmetric
  /// @note   Collective on `comm`.
  petsc::Matrix to_matrix(MPI_Comm comm, double negligible = 0.0);

 private:
  bool holds_all(std::ptrdiff_t block) const
  {
    return offset_[block + 1] - offset_[block] == std::ptrdiff_t(pattern_.n) * pattern_.n;
  }
  /// Makes room for what the matrix has in these blocks and none had before.
  void make_room(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places);
  void widen(std::uint64_t components);

  const BlockPattern& pattern_;
  std::uint64_t components_ = 0;        ///< bit n * i + j: blocks have an entry (i, j)
  std::vector<int> held_;               ///< n * i + j of these, ascending
  std::vector<std::ptrdiff_t> offset_;  ///< [n_blocks + 1] of the blocks in the values
  std::vector<double> values_;          ///< of each block all n^2, or those held
};

}  // namespace chladni::plate
