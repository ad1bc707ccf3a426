#pragma once

#include <memory>
#include <vector>

#include "linear/cholesky/supernodal/front_places.hpp"

namespace chladni::linear {

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

}  // namespace chladni::linear
