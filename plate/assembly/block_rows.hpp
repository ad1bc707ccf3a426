#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::plate {

/// The pattern of the n x n blocks of a square matrix in the rows of the nodes first, first + 1,
/// ..., in CSR form.
struct BlockPattern {
  int n = 6;  ///< DOFs of each node
  PetscInt first = 0;
  std::vector<std::ptrdiff_t> start;  ///< [n_rows + 1] start of each row in `column`
  std::vector<PetscInt> column;       ///< node numbers, ascending in each row
  /// Nodes that others follow, ascending: their blocks may have any entry.
  std::vector<PetscInt> full = {};

  PetscInt n_rows() const { return static_cast<PetscInt>(start.size()) - 1; }
};

/// Makes a pattern.
/// @param n           DOFs of each node
/// @param first       node of the first row
/// @param neighbours  [n_rows] for each row the nodes that share an element with it, in any order
BlockPattern block_pattern(int n, PetscInt first, std::vector<std::vector<PetscInt>> neighbours);

/// The places of the blocks of an element matrix among the blocks of the pattern.
/// @param nodes  numbers of the nodes of the element; a node may occur twice
/// @return [n_nodes x n_nodes] by rows; -1 where the row is not in the pattern
std::vector<std::ptrdiff_t> block_places(const BlockPattern& pattern,
                                         std::span<const PetscInt> nodes);

/// Whether the rows of a node need the same columns.
enum class Rows { as_they_are, alike };

/// Sums element matrices over a pattern. Each entry is summed in the order of the calls, on
/// whatever rank its row is. Only those components of a block are stored that some element has,
/// except in blocks of full nodes. For plane shells this is half of K and a sixth of M; first-time
/// access to memory dominates the time.
class BlockRows {
 public:
  explicit BlockRows(const BlockPattern& pattern) : pattern_(pattern) {}

  /// Adds the rows of `A_e` whose nodes are in the pattern.
  /// @param A_e     symmetric, or the transpose of what is added; n rows for each of its nodes
  /// @param places  `block_places` of its nodes
  void add(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places);

  /// The matrix of block size n, without zeros off the diagonal. This object is empty afterwards.
  /// @note   Collective on `comm`.
  petsc::Matrix to_matrix(MPI_Comm comm);
  /// The same of a symmetric matrix.
  /// @param negligible  entries with |A_ij| <= negligible sqrt |A_ii A_jj| are round-off and
  /// dropped
  /// @param rows        alike: with zeros where `make_rows_alike` adds an entry, of components that
  ///                    each rank with rows has
  petsc::Matrix to_symmetric_matrix(MPI_Comm comm, double negligible, Rows rows);

 private:
  bool holds_all(std::ptrdiff_t block) const
  {
    return offset_[block + 1] - offset_[block] == std::ptrdiff_t(pattern_.n) * pattern_.n;
  }
  /// Makes room for the components of `A_e` that no block had before.
  void make_room(const Eigen::MatrixXd& A_e, std::span<const std::ptrdiff_t> places);
  void widen(std::uint64_t components);

  const BlockPattern& pattern_;
  std::uint64_t components_ = 0;        ///< bit n * i + j: blocks store the entry (i, j)
  std::vector<int> held_;               ///< n * i + j of the stored components, ascending
  std::vector<std::ptrdiff_t> offset_;  ///< [n_blocks + 1] start of each block in the values
  /// All n^2 values of each block, or its stored components.
  std::vector<double> values_;
};

}  // namespace chladni::plate
