#pragma once

#include <vector>

#include "linear/solver_options.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// V = (K - Omega_0^2 M)^-1 E: responses of the free system to harmonic unit loads E on some DOFs.
/// They are the frequency-response modes in the space of the whole model. One factorisation.
/// @param Omega_0  rad/s
/// @param loaded   global DOFs, the same list on every rank
/// @return [n x n_loads] dense, rows as K; m/N and the like
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when Omega_0 is an eigenfrequency of the model to round-off.
petsc::Matrix full_responses(Mat K, Mat M, double Omega_0, const std::vector<PetscInt>& loaded);

/// Harmonic unit loads at one excitation frequency.
struct HarmonicLoads {
  double Omega_0;                ///< rad/s
  std::vector<PetscInt> loaded;  ///< global DOFs, the same list on every rank
};

/// The responses to several sets of loads, side by side; one factorisation for each set.
/// @return [n x all n_loads] dense, rows as K
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error as the function above.
/// Options: `-<prefix>response_mat_mumps_...`
petsc::Matrix full_responses(Mat K, Mat M, const std::vector<HarmonicLoads>& loads,
                             const linear::OptionSource& source = {});

/// The blocks K_ss and M_ss.
struct SlaveBlocks {
  Mat K, M;
};

/// Fixed-interface modes with further columns.
struct Enrichment {
  FixedInterfaceModes modes;  ///< Phi and omega with the new columns behind the others
  PetscInt n_added;           ///< less than columns of V if these depend on the basis or each other
};

/// Adds columns X to Phi, so that the span of [I 0; Psi Phi X] holds V. X is zero at the masters as
/// Phi is, with Phi^T M_ss X = 0, X^T M_ss X = I and X^T K_ss X = diag(omega^2): the reduced model
/// keeps its form. The omega of X are Rayleigh quotients and no frequencies of the model. Pass all
/// vectors at once: columns of a second call would not be K-orthogonal to those of the first.
/// @param V  [n x k] dense, rows as the whole system
/// @note   Collective.
Enrichment enrich(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, const SlaveBlocks& ss,
                  Mat V);

}  // namespace chladni::reduce
