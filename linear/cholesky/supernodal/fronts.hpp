#pragma once

#include <memory>
#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"

namespace chladni::linear {

/// Rows of a symmetric matrix in compressed form, columns global.
struct MatrixRows {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
  std::vector<int> place;  ///< [n] where each row of the matrix stands; -1: not on this rank
};

/// Multifrontal elimination A = L D L^T. Source: Duff and Reid, ACM TOMS 9 (1983) 302.
class Fronts {
 public:
  Fronts(const AssemblyTree& tree, const MatrixRows& A);

  /// Eliminates the columns of s; those of its children that are here hand on what they have left.
  /// @return the number of negative pivots, -1 at a pivot that is zero or no number.
  /// @throws chladni::Error when the matrix has entries that the tree has no place for.
  int eliminate(int s);
  /// The columns of L that were eliminated last, with D on the diagonal:
  /// [(n_columns + n_below) x n_columns], by columns.
  const double* columns() const { return columns_.data(); }
  /// What is left for the parent of s: lower triangle [n_below x n_below], by columns. Exists from
  /// the elimination of s to that of its parent, or from this call on.
  double* left_over(int s);
  const std::vector<int>& children(int s) const { return children_[s]; }

 private:
  void add_entries(int s);
  void add_left_over(int child, int s);
  std::size_t in_front(int position, int s) const;
  bool has_place(int position, int s) const;

  const AssemblyTree& tree_;
  const MatrixRows& A_;
  std::vector<std::vector<int>> children_;
  std::vector<int> place_below_;                  ///< [n] of the rows below the supernode at hand
  std::vector<double> columns_, scaled_columns_;  ///< L with D, L D
  std::vector<std::unique_ptr<double[]>> left_over_;  // NOLINT(modernize-avoid-c-arrays)
};

/// Numbers of all left-overs that are there at the same time, at most, when `supernodes` are
/// eliminated one after the other.
double peak_of_left_overs(const AssemblyTree& tree, const std::vector<int>& supernodes);

}  // namespace chladni::linear
