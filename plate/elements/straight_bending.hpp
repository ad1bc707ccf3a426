#pragma once

#include <Eigen/Core>

namespace chladni::plate {

/// Bending of a straight line of order p in one plane. The deflection w is of degree 2 p + 1, and
/// the rotation of the sections beta is what the moments ask for,
///   kappa G A (w' - beta) + E I beta'' = 0:   beta = w' + a w''' + a^2 w^(5) + ...,
/// a = E I / (kappa G A). Nodes at equal distances have w and beta. p = 1 is the beam without loads
/// between its nodes; a = 0 are Hermite's polynomials.
/// Source: Friedman and Kosmatka, Comput. Struct. 47 (1993) 473, for p = 1.
class StraightBending {
 public:
  /// @param length  l, m
  /// @param a       m^2
  StraightBending(int order, double length, double a);

  /// w, beta and the derivatives of beta by x as linear forms in (w_1, beta_1, w_2, ...).
  struct Forms {
    Eigen::RowVectorXd w, beta, beta_x, beta_xx;  ///< [1 x 2 p + 2]
  };

  /// @param xi  in [-1, 1]
  Forms at(double xi) const;

 private:
  double half_;  ///< l / 2
  /// Coefficients of the powers of xi, [2 p + 2 x 2 p + 2].
  Eigen::MatrixXd w_, beta_, beta_x_, beta_xx_;
};

}  // namespace chladni::plate
