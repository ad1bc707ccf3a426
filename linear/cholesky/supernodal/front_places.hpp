#pragma once

#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"

namespace chladni::linear {

/// Rows of a symmetric matrix in CSR form with global columns.
struct MatrixRows {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
  /// [n] place of each row of the matrix in these arrays; -1: not on this rank
  std::vector<int> place;
};

/// The rows of the front of one supernode: its columns, and the rows below them.
class FrontPlaces {
 public:
  explicit FrontPlaces(const AssemblyTree& tree) : tree_(tree), place_below_(tree.row.size()) {}

  /// Turns to the front of s.
  void enter(int s)
  {
    s_ = s;
    const std::span<const int> below = tree_.below(s);
    for (std::size_t i = 0; i < below.size(); ++i) place_below_[below[i]] = static_cast<int>(i);
  }
  /// The place in the front of a row that it has, given by its position in the elimination.
  int place(int position) const
  {
    const int column = position - tree_.first_column[s_], n = tree_.n_columns(s_);
    return column < n ? column : n + place_below_[position];
  }
  /// Calls add(row, column, value), in places of the front, for the entries of A in the lower
  /// triangle of the columns.
  /// @throws chladni::Error when the matrix has entries outside the structure of the tree.
  template <typename Add>
  void for_entries(const MatrixRows& A, const Add& add) const
  {
    for (int p = tree_.first_column[s_]; p < tree_.first_column[s_ + 1]; ++p) {
      const int row = A.place[tree_.row[p]];
      for (PetscInt k = A.starts[row]; k < A.starts[row + 1]; ++k) {
        const int q = tree_.position[A.columns[k]];
        if (q < p) continue;
        if (!has(q)) refuse(tree_.row[p], A.columns[k]);
        add(place(q), p - tree_.first_column[s_], A.values[k]);
      }
    }
  }

 private:
  bool has(int position) const;
  [[noreturn]] static void refuse(int row, PetscInt column);

  const AssemblyTree& tree_;
  std::vector<int> place_below_;  ///< [n] for the rows below the columns of s
  int s_ = 0;
};

}  // namespace chladni::linear
