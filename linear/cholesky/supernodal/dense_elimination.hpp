#pragma once

#include <cstddef>

namespace chladni::linear {

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

}  // namespace chladni::linear
