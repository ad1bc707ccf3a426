#pragma once

#include <cstddef>

namespace chladni::linear {

/// The columns of a front, of which the first `n_columns` are eliminated: A = L D L^T.
struct FrontColumns {
  double* A;  ///< [n_rows x n_columns] by columns; lower triangle; becomes L, D on its diagonal
  double* W;  ///< as large; becomes L D below the diagonal
  int n_rows;
  int n_columns;
};

/// Without square roots and without pivoting: on stiff bodies that nearly float, a triangle L L^T
/// loses three to sixty times as much of the rigid motions.
/// @return the number of negative pivots, -1 at a pivot that is zero or no number.
int eliminate_columns(const FrontColumns& front);

/// C <- scale C - L_21 D L_21^T; lower triangle of what lies below the columns, by columns.
void subtract_from_rest(const FrontColumns& front, double scale, double* C);

}  // namespace chladni::linear
