#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
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

/// Some numbers of each node in the columns of a pattern, which ranks have for their rows.
class NodeValues {
 public:
  /// @param own  [n n_rows] n numbers of each node of this rank
  /// @note   Collective on `comm`.
  NodeValues(const BlockPattern& pattern, std::vector<double> own, MPI_Comm comm);

  /// [n] those of a node in the columns of the pattern.
  const double* of(PetscInt node) const;

 private:
  PetscInt n_, first_;
  std::vector<double> own_, other_;
  std::vector<PetscInt> other_nodes_;  ///< ascending
};

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

/// Rows in CSR form, split into the entries in the columns of this rank, counted from its first
/// column, and the entries in other columns.
struct SplitRows {
  std::vector<PetscInt> start{0};
  std::unique_ptr<PetscInt[]> column;
  std::vector<double> value;
  std::vector<PetscInt> other_start{0}, other_column;
  std::vector<double> other_value;
};

/// Where the sums over a pattern are stored.
struct HeldBlocks {
  const BlockPattern& pattern;
  const std::vector<int>& held;  ///< n * i + j of the components that partly stored blocks have
  const std::vector<std::ptrdiff_t>& offset;  ///< [n_blocks + 1] start of each block
};

/// sqrt |A_ii| of the rows of this rank.
std::vector<double> diagonal_scales(const HeldBlocks& blocks, const std::vector<double>& values);

/// Decides which values are entries: those above `negligible` times the scale sqrt |A_ii A_jj| of
/// their place. No entry of a positive semidefinite matrix is larger, and the errors of a Cholesky
/// factorisation are a few eps of it.
/// Source: Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3.
struct Sieve {
  double negligible;
  const NodeValues* scales;  ///< sqrt |A_ii|; null: all but zeros are entries

  /// [n] sqrt |A_ii| of the DOFs of a node; zeros without scales.
  const double* of(PetscInt node) const
  {
    static constexpr std::array<double, 6> zeros{};
    return scales ? scales->of(node) : zeros.data();
  }
  /// True if the value is an entry. The result is symmetric to the last bit; NaN is an entry.
  bool counts(double value, double row_scale, double column_scale) const
  {
    return !(std::abs(value) <= negligible * (row_scale * column_scale));
  }
};

/// Which values of each block are entries: what the sieve lets pass, and the diagonal. The others
/// become zero.
/// @return [n_blocks]
std::vector<BlockEntries> sifted(const HeldBlocks& blocks, const Sieve& sieve,
                                 std::vector<double>& values);

/// Turns the sums over a pattern into rows of scalars. The values stay in the memory of the sums,
/// since the rows of a node are never longer than its blocks.
/// @param entries  [n_blocks] of each block; where a partly stored one has no value, there is none
/// @throws chladni::Error when there are more entries than a PetscInt counts.
SplitRows split_rows(const HeldBlocks& blocks, std::vector<double> values,
                     const std::vector<BlockEntries>& entries);

}  // namespace chladni::plate
