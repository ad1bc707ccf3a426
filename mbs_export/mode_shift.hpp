#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/held_dofs.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {

/// The free modes under the constraint 0 = Q_dd q_d + Q_di q_i on n_c held displacements: q = Q_c
/// q_i with Q_c = [-Q_dd^-1 Q_di; I], rows in the order of the free modes.
struct ModeShift {
  Eigen::MatrixXd Q_c;  ///< [n_modes x n_modes - n_c]
  Eigen::MatrixXd K_c;  ///< Q_c^T diag(omega^2) Q_c, rad^2/s^2
  Eigen::MatrixXd M_c;  ///< Q_c^T Q_c
  /// [n_modes - n_c x n_free_rigid] remaining rigid motions, M_c-orthonormal
  Eigen::MatrixXd R_c;
  std::vector<int> dependent;  ///< [n_c] the modes d, ascending
  /// condition number of Q_dd; 1 if nothing is held
  double condition_Q_dd;
  /// Condition number of Q_dd with rows of unit length: the mutual dependence of the held
  /// displacements, whatever their units. 1 if nothing is held.
  double condition_directions;
};

/// Mode shifting. Dependent modes are the rigid ones as far as they are independent at the held
/// DOFs; further ones are chosen by pivoting among the elastic modes, with a preference for low
/// frequencies.
/// @throws chladni::Error naming the DOFs when no choice has cond(Q_dd) below 1e6.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held);

/// Orthonormal combinations of rigid motions that leave the held DOFs at rest, [n_rigid x k].
/// @param held_displacements  [n_c x n_rigid] of each motion
Eigen::MatrixXd unheld_combinations(const Eigen::MatrixXd& held_displacements);

/// Mode shifting with given dependent modes.
/// @param dependent  [n_c] indices of free modes, ascending
/// @throws chladni::Error naming the DOFs when cond(Q_dd) > 1e6 in rows of unit length, and when
///         very stiff modes leave the lowest eigenvalue to rounding.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held,
                      const std::vector<int>& dependent);

}  // namespace chladni::mbs_export
