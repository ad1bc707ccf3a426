#pragma once

#include <vector>

#include "linear/solver_options.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// V = (K - Omega_0^2 M)^-1 E of harmonic unit loads E on some DOFs of the free system: what
/// frequency-response modes are in the space of the whole model. One factorisation.
/// @param loaded  global DOFs, the same list on every rank
/// @return [n x n_loads] dense, rows as K; m/N and the like
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when Omega_0 is an eigenfrequency of the model to round-off.
petsc::Matrix full_responses(Mat K, Mat M, double Omega_0, const std::vector<PetscInt>& loaded);

/// Loads at one excitation frequency, rad/s.
struct HarmonicLoads {
  double Omega_0;
  std::vector<PetscInt> loaded;  ///< global DOFs, the same list on every rank
};

/// The responses to all of these, side by side; a factorisation for each.
/// Options: `-<prefix>response_mat_mumps_...`
petsc::Matrix full_responses(Mat K, Mat M, const std::vector<HarmonicLoads>& loads,
                             const linear::OptionSource& source = {});

/// K_ss and M_ss.
struct SlaveBlocks {
  Mat K, M;
};

/// What reduced modes miss of some vectors V.
struct Enrichment {
  FixedInterfaceModes modes;  ///< Phi and omega with the new columns behind the others
  PetscInt n_added;           ///< fewer than vectors where these depend on the basis or each other
};

/// Columns X behind Phi, so that the span of [I 0; Psi Phi X] holds V: zero at the masters as Phi,
/// with Phi^T M_ss X = 0, X^T M_ss X = I and X^T K_ss X = diag(omega^2), so that all that is known
/// of the blocks of fixed-interface modes holds for them too. Their omega are Rayleigh quotients
/// and no frequencies of the model. All vectors at once: columns of a second call would not be
/// K-orthogonal to those of the first.
/// @param V  [n x k] dense, rows as the whole system
/// @note   Collective.
Enrichment enrich(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, const SlaveBlocks& ss,
                  Mat V);

}  // namespace chladni::reduce
