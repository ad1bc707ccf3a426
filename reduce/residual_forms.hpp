#pragma once

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// A basis and its model while shapes join them: K_qq is a diagonal matrix, M_qq any.
struct GrowingBasis {
  const linear::Factorization& K_ss;
  const Blocks& K;
  const Blocks& M;
  CraigBamptonBasis& Q_CB;
  ReducedModel& model;
};

/// What motions x of a reduced model leave of forces at the slaves, at any frequency: with
/// r = K_ss Phi x_q - s (B x_m + D x_q), B = M_ss Psi + M_sm, D = M_ss Phi,
/// r^T K_ss^-1 r = x_q^T K_qq x_q - 2 s x_q^T (M_qm x_m + M_qq x_q) + s^2 x^T H x.
class ResidualForms {
 public:
  /// All of it must outlive this. One block solve of n_m + n_CB columns, which stay.
  /// @note   Collective, as all of this class.
  explicit ResidualForms(const GrowingBasis& basis);

  /// [l x l] G = r^T K_ss^-1 r of motions X [n_m + n_CB x l], s = Omega^2.
  Eigen::MatrixXd energy(const Eigen::MatrixXd& X, double s) const;
  /// [n_s x l] K_ss^-1 r, zero at the masters: the shapes that would add most.
  petsc::Matrix shapes(const Eigen::MatrixXd& X, double s) const;
  /// Adds shapes to the basis and the model, K-orthonormal and K-orthogonal to those before; fewer
  /// where they depend on these or each other.
  void append(Mat shapes);
  /// Ritz vectors take the place of the shapes: K_qq = diag(omega^2), M_qq = I. The forms are those
  /// of before and of no more use.
  void make_ritz();

 private:
  /// B^T K_ss^-1 B
  Eigen::MatrixXd forms_of_masters();

  GrowingBasis of_;
  petsc::Matrix z_B_, z_D_;  ///< K_ss^-1 B, K_ss^-1 D
  Eigen::MatrixXd H_;        ///< [B D]^T K_ss^-1 [B D]
};

}  // namespace chladni::reduce
