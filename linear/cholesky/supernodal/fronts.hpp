#pragma once

#include <cstddef>
#include <memory>
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

/// Multifrontal elimination A = L D L^T.
/// Source: Duff and Reid, ACM TOMS 9 (1983) 302.
class Fronts {
 public:
  Fronts(const AssemblyTree& tree, const MatrixRows& A);

  /// Eliminates the columns of s. Children of s on this rank pass on their update matrices.
  /// @return the number of negative pivots; -1 at a pivot that is zero or NaN
  /// @throws chladni::Error when the matrix has entries outside the structure of the tree.
  int eliminate(int s);
  /// The columns of L that were eliminated last, with D on the diagonal: [(n_columns + n_below) x
  /// n_columns], by columns.
  const double* columns() const { return columns_.data(); }
  /// The update matrix of s for its parent: lower triangle [n_below x n_below], by columns. It
  /// exists from the elimination of s, or from this call on, until the elimination of its parent.
  double* left_over(int s);
  void forget_left_over(int s) { left_over_[s].reset(); }
  const std::vector<int>& children(int s) const { return children_[s]; }

 private:
  void add_entries(int s);
  void add_left_over(int child, int s);

  const AssemblyTree& tree_;
  const MatrixRows& A_;
  FrontPlaces places_;
  std::vector<std::vector<int>> children_;
  std::vector<double> columns_, scaled_columns_;      ///< L with D, L D
  std::vector<std::unique_ptr<double[]>> left_over_;  // NOLINT(modernize-avoid-c-arrays)
};

/// The largest number of entries of all update matrices that exist at the same time, when
/// `supernodes` are eliminated in their order.
double peak_of_left_overs(const AssemblyTree& tree, const std::vector<int>& supernodes);

/// The columns of a front, the first `n_columns` of which are eliminated: A = L D L^T.
struct FrontColumns {
  double* A;  ///< [n_rows x n_columns] by columns; lower triangle; becomes L, D on its diagonal
  double* W;  ///< as large; becomes L D below the diagonal
  int n_rows;
  int n_columns;
};

/// Eliminates without square roots and without pivoting. On stiff bodies that are nearly free, a
/// factorisation L L^T loses three to sixty times as much of the rigid motions.
/// @return the number of negative pivots; -1 at a pivot that is zero or NaN
int eliminate_columns(const FrontColumns& front);

/// C <- scale C - L_21 D L_21^T, the lower triangle of the rows below the columns, stored by
/// columns.
void subtract_from_rest(const FrontColumns& front, double scale, double* C);

/// The rows of a matrix that this rank eliminates, gathered from the ranks that own them.
class GatheredRows {
 public:
  /// @param is_needed  [n rows]
  /// @param position   [n rows] in the elimination: of a row, the entries in columns that come
  ///                   before it are left out where rows are gathered
  /// @note   Collective.
  GatheredRows(Mat A, const std::vector<char>& is_needed, const std::vector<int>& position);
  ~GatheredRows();
  GatheredRows(const GatheredRows&) = delete;
  GatheredRows& operator=(const GatheredRows&) = delete;
  const MatrixRows& rows() const { return rows_; }

 private:
  void borrow(Mat A);
  void gather(Mat A, const std::vector<PetscInt>& rows, const std::vector<int>& position);

  Mat borrowed_ = nullptr;
  std::vector<PetscInt> starts_;
  std::unique_ptr<PetscInt[]> columns_;
  std::unique_ptr<PetscScalar[]> values_;
  MatrixRows rows_{};
};

}  // namespace chladni::linear
