#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/held_dofs.hpp"
#include "mbs_export/orthogonalize.hpp"

namespace chladni::mbs_export {

/// The free modes under the constraint 0 = Q_dd q_d + Q_di q_i on n_c held displacements:
/// q = Q_c q_i with Q_c = [-Q_dd^-1 Q_di; I], rows in the order of the free modes.
struct ModeShift {
  Eigen::MatrixXd Q_c;  ///< [n_modes x n_modes - n_c]
  Eigen::MatrixXd K_c;  ///< Q_c^T diag(omega^2) Q_c, rad^2/s^2
  Eigen::MatrixXd M_c;  ///< Q_c^T Q_c
  Eigen::MatrixXd R_c;  ///< [n_modes - n_c x n_free_rigid] rigid motion left, M_c-orthonormal
  std::vector<int> dependent;  ///< [n_c] the modes d, ascending
  double condition_Q_dd;       ///< 1 when nothing is held
  /// Of Q_dd with rows of unit length: how far the held displacements depend on one another,
  /// whatever their units. 1 when nothing is held.
  double condition_directions;
};

/// Mode shifting with the rigid modes as dependent ones, as far as they are independent at the held
/// DOFs; further ones are taken by pivoting among the elastic modes, low frequencies preferred.
/// @throws chladni::Error naming the DOFs when no choice has cond(Q_dd) below 1e6.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held);

/// Combinations of rigid motions that leave the held DOFs at rest, orthonormal: [n_rigid x k].
/// @param held_displacements  [n_c x n_rigid] of each motion
Eigen::MatrixXd unheld_combinations(const Eigen::MatrixXd& held_displacements);

/// The same with a choice of dependent modes by hand.
/// @param dependent  [n_c] indices of free modes, ascending
/// @throws chladni::Error when cond(Q_dd) > 1e6, in rows of unit length, naming the DOFs, and when
///         modes too stiff leave the lowest eigenvalue to rounding.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held,
                      const std::vector<int>& dependent);

}  // namespace chladni::mbs_export
