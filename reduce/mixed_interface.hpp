#pragma once

#include <limits>
#include <vector>

#include "reduce/craig_bampton.hpp"
#include "reduce/reduce_options.hpp"

namespace chladni::reduce {

/// The FE model with its partition, its blocks and the factor of K_ss.
struct WholeSystem {
  Mat K, M;                  ///< of all DOFs
  const DofPartition& dofs;  ///< the partition of K_ss and of the blocks
  const Blocks& K_blocks;
  const Blocks& M_blocks;
  const linear::Factorization& K_ss;
};

/// The lowest modes X of the body with some masters held and the others free, X^T M X = I. The
/// rigid-body motions that the supports leave come first.
struct MixedInterfaceModes {
  petsc::Matrix X_s;          ///< [n_s x k] dense
  Eigen::MatrixXd X_m;        ///< [n_m x k], on every rank
  std::vector<double> omega;  ///< [k] rad/s; 0 for the rigid-body motions
  PetscInt n_rigid;
  /// rad^2/s^2 of the first mode that is not included; infinity if there is none
  double lambda_left_out = std::numeric_limits<double>::infinity();

  PetscInt n_modes() const { return static_cast<PetscInt>(omega.size()); }
};

/// Computes modes with free masters by number (of elastic modes), up to a frequency, or all in the
/// range of a tolerance. Only the factor of K_ss is needed.
/// @param held  rows among the masters, ascending; empty for Rubin's modes
/// @note   Collective, as are all functions of this header.
/// @throws chladni::Error when there are fewer modes.
MixedInterfaceModes mixed_interface_modes(const WholeSystem& body, Mat Psi,
                                          const ReduceOptions& wanted,
                                          const std::vector<int>& held = {});

/// The basis of Herting and Hintz, or Rubin's if no master is held: the modes of the body, the
/// constraint modes of the held masters and the residual flexibility of the free ones. The modes
/// and the two sets of static shapes are statically complete, so their span contains the constraint
/// modes Psi; it is completed by the shapes T = K_ss^-1 (M_ss X_s + M_sm X_m) in which inertia
/// deforms the body with all masters held. For an elastic mode lambda T = X_s - Psi X_m, but T
/// avoids the cancellation of that difference. Ritz vectors of (K_ss, M_ss) in the span of T take
/// the place of fixed-interface modes: the reduced model has the form of Craig and Bampton, with
/// the frequencies of the modes X.
/// @return Phi [n_s x k]; omega are the square roots of the Ritz values
/// Source: Herting, Finite Elem. Anal. Des. 1 (1985) 153; Hintz, AIAA J. 13 (1975) 1007; Rubin,
/// AIAA J. 13 (1975) 995; Craig and Chang, AIAA J. 14 (1976) 1633.
FixedInterfaceModes residual_modes(const WholeSystem& body, const MixedInterfaceModes& modes);

}  // namespace chladni::reduce
