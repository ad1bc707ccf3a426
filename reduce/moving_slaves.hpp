#pragma once

#include <functional>
#include <span>
#include <vector>

#include "linear/cholesky/inverse_form.hpp"
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

}  // namespace chladni::reduce
