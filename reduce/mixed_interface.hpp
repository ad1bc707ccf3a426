#pragma once

#include <limits>
#include <vector>

#include "reduce/craig_bampton.hpp"
#include "reduce/reduce_options.hpp"

namespace chladni::reduce {

/// The FE model and what is known of it.
struct WholeSystem {
  Mat K, M;                  ///< all DOFs
  const DofPartition& dofs;  ///< as K_ss, Psi and the blocks
  const Blocks& K_blocks;
  const Blocks& M_blocks;
  const linear::Factorization& K_ss;
};

/// The lowest modes X of the body with some of its masters held and the others free, X^T M X = I;
/// first the rigid-body motions that these supports allow.
struct MixedInterfaceModes {
  petsc::Matrix X_s;          ///< [n_s x k] dense
  Eigen::MatrixXd X_m;        ///< [n_m x k], on every rank
  std::vector<double> omega;  ///< [k] rad/s; 0 for the rigid-body motions
  PetscInt n_rigid;
  /// rad^2/s^2 of the first mode that is not among these; infinite where there are no others
  double lambda_left_out = std::numeric_limits<double>::infinity();

  PetscInt n_modes() const { return static_cast<PetscInt>(omega.size()); }
};

/// By number (of elastic modes), up to a frequency, or all of the range of a tolerance. Nothing is
/// factorised but K_ss.
/// @param held  rows among the masters, ascending; none: Rubin's and MacNeal's modes
/// @note   Collective, as all of this header.
/// @throws chladni::Error when there are not as many modes.
MixedInterfaceModes mixed_interface_modes(const WholeSystem& body, Mat Psi,
                                          const ReduceOptions& wanted,
                                          const std::vector<int>& held = {});

/// The basis of Herting and Hintz, and where no master is held Rubin's: the modes of the body, the
/// constraint modes of the held masters and the residual flexibility of the free ones. The latter
/// two and the modes are statically complete, so that the constraint modes Psi lie in that space,
/// and next to them the shapes T = K_ss^-1 (M_ss X_s + M_sm X_m) in which inertia deforms the body
/// with all masters held: of an elastic mode lambda T = X_s - Psi X_m, without the digits that the
/// difference loses. Ritz vectors of (K_ss, M_ss) among these take the place of fixed-interface
/// modes: the reduced model has the form of Craig and Bampton, with the frequencies of the modes X.
/// @return Phi [n_s x k], omega: square roots of the Ritz values
/// Source: Herting, Finite Elem. Anal. Des. 1 (1985) 153; Hintz, AIAA J. 13 (1975) 1007; Rubin,
/// AIAA J. 13 (1975) 995; Craig and Chang, AIAA J. 14 (1976) 1633.
FixedInterfaceModes residual_modes(const WholeSystem& body, const MixedInterfaceModes& modes);

/// MacNeal's mass on Rubin's basis: that of the free modes alone, M_r = Z^T Z with Z = X^T M Q;
/// residual flexibility is massless. No Galerkin projection: frequencies may be too low.
/// Source: MacNeal, Computers & Structures 1 (1971) 581.
Eigen::MatrixXd macneal_mass(const CraigBamptonBasis& Q, const Blocks& M,
                             const MixedInterfaceModes& modes);

}  // namespace chladni::reduce
