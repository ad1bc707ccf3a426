#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linear/cholesky/part_solver.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// The slaves that some motions of a reduced model move, and the matrices between them: all slaves,
/// or those of some of the parts into which K_ss and M_ss fall, as those of the bending of a flat
/// plate.
class MovingSlaves {
 public:
  /// Those that some masters move, and with them modes and further parts that these modes move.
  /// @param K_ss, M, Q_CB  must outlive this object; all slaves where the factor of K_ss solves for
  ///                       no parts
  /// @param moving         masters, ascending
  /// @note   Collective, as are all members but the plain accessors.
  MovingSlaves(const linear::Factorization& K_ss, const Blocks& M, const CraigBamptonBasis& Q_CB,
               const std::vector<int>& moving);

  bool are_all() const { return !rows_; }
  Mat K_ss() const { return are_all() ? factor_.matrix() : Mat(K_ss_); }
  Mat M_ss() const { return are_all() ? M_.ss : Mat(M_ss_); }
  /// [moving slaves x n_m]
  Mat M_sm() const { return are_all() ? M_.sm : Mat(M_sm_); }
  /// [moving slaves x masters()]
  Mat Psi() const { return are_all() ? Mat(Q_CB_.Psi) : Mat(Psi_); }
  /// The masters that move these slaves, and all that were given, ascending.
  const std::vector<int>& masters() const { return masters_; }

  /// The rows of these slaves of a dense X [n_s x k].
  petsc::Matrix rows_of(Mat X) const;
  /// Columns first .. last - 1 of a dense X of these slaves, zero at all others.
  petsc::Matrix of_all(Mat X, PetscInt first, PetscInt last) const;
  /// K_ss^-1 F
  petsc::Matrix solution(Mat F) const;
  /// B^T K_ss^-1 B, in the place of B where the factor halves.
  bool halves() const { return linear::halves(factor_.factor()); }
  linear::InverseForm inverse_form(petsc::Matrix B) const;

 private:
  const linear::Factorization& factor_;
  const Blocks& M_;
  const CraigBamptonBasis& Q_CB_;
  petsc::IndexSet rows_;  ///< of K_ss; empty: all
  petsc::Matrix K_ss_, M_ss_, M_sm_, Psi_;
  std::vector<int> masters_;
  std::function<void(Mat B, Mat X)> solve_;
  std::function<linear::InverseForm(petsc::Matrix B)> form_;
};

/// A copy of some columns of a dense matrix.
petsc::Matrix columns_of(Mat X, std::span<const int> numbers);

/// A basis and its model while shapes are added: K_qq is diagonal, M_qq need not be.
struct GrowingBasis {
  const linear::Factorization& K_ss;
  const Blocks& K;
  const Blocks& M;
  CraigBamptonBasis& Q_CB;
  ReducedModel& model;
  /// Masters that the motions to be measured move, ascending; without a list all of them.
  std::optional<std::vector<int>> moving = {};
};

/// Motions whose elastic forces and inertia forces at the slaves are of different frequencies.
struct ForcedMotions {
  Eigen::MatrixXd elastic;  ///< [n_CB x l] the part of the modes, whose forces are K_ss Phi p
  Eigen::MatrixXd inertia;  ///< [n_m + n_CB x l] less those of inertia, B x_m + D x_q
};

/// Residual forces at the slaves that motions x of a reduced model leave at any frequency, s =
/// Omega^2: r = K_ss Phi x_q - s (B x_m + D x_q) with B = M_ss Psi + M_sm, D = M_ss Phi, and
/// r^T K_ss^-1 r = x_q^T K_qq x_q - 2 s x_q^T (M_qm x_m + M_qq x_q) + s^2 x^T H x.
class ResidualForms {
 public:
  /// What `basis` refers to must outlive this object. With our own factor half a solution for each
  /// moving master and each of n_CB columns, which stay in memory.
  /// @note   Collective, as are all members.
  explicit ResidualForms(const GrowingBasis& basis);

  /// G = r^T K_ss^-1 r of the residuals of motions X.
  /// @param X  [n_m + n_CB x l], zero at masters that do not move
  /// @param s  Omega^2, rad^2/s^2
  /// @return [l x l]
  Eigen::MatrixXd energy(const Eigen::MatrixXd& X, double s) const;
  Eigen::MatrixXd energy(const ForcedMotions& motions) const;
  /// K_ss^-1 r of motions X: the shapes, zero at the masters, that reduce the error most.
  /// @return [slaves that move x l] dense
  petsc::Matrix shapes(const Eigen::MatrixXd& X, double s) const;
  /// Adds shapes to the basis and the model, made K-orthonormal and K-orthogonal to the earlier
  /// ones. Shapes that depend on these or on each other are left out.
  void append(Mat shapes);
  /// Replaces the shapes by Ritz vectors: K_qq = diag(omega^2), M_qq = I. Afterwards this object
  /// must not be used again.
  void make_ritz();

 private:
  petsc::Matrix inertia_of_masters(std::size_t first, std::size_t last) const;
  /// B^T K_ss^-1 B, [n_m x n_m], zero where a master does not move.
  Eigen::MatrixXd forms_of_masters();
  /// B^T K_ss^-1 F, [n_m x k].
  Eigen::MatrixXd with_masters(Mat right) const;

  Mat Phi() const { return slaves_.are_all() ? Mat(of_.Q_CB.modes->Phi) : Mat(own_Phi_); }
  petsc::Matrix all_shapes();

  GrowingBasis of_;
  std::vector<int> moving_;
  MovingSlaves slaves_;
  petsc::Matrix own_Phi_;          ///< at the slaves that move, if these are not all
  petsc::Matrix left_B_, left_D_;  ///< `linear::InverseForm::left` of B (moving masters) and D
  Eigen::MatrixXd H_;              ///< [B D]^T K_ss^-1 [B D]
};

}  // namespace chladni::reduce
