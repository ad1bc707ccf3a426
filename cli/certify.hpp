#pragma once

#include <vector>

#include "cli/scene/scene.hpp"
#include "mbs_export/reduced_system.hpp"
#include "reduce/error_estimates.hpp"

namespace chladni::cli {

/// What a certificate needs of the reduction.
struct Reduction {
  const reduce::Factorization& K_ss;
  const reduce::CraigBamptonBasis& Q_CB;
  const reduce::Blocks& M;
  const reduce::ReducedModel& model;
  /// For each coordinate of the file its place in the model.
  const std::vector<int>& places;
};

/// The error estimates of the supported body's modes up to `omega_max` (at most 100 of them) with
/// the first `n_modes` fixed-interface modes.
/// @param system  [first rank] the reduced system in the order of the file, with all modes
/// @note   Collective on all ranks.
/// @throws chladni::Error when the support does not fit the system.
mbs_export::Certificate certify(const mbs_export::ReducedSystem& system, const Reduction& reduction,
                                const std::vector<std::string>& fixed, int n_modes,
                                double omega_max);

/// A spectrum under a support.
struct HeldSpectrum {
  std::vector<double> lambda;  ///< all positive eigenvalues, ascending; rad^2/s^2
  int n_rigid;                 ///< zero ones
  std::vector<int> held_rows;  ///< of K_r
};

/// Of the reduced system under the support of its certificate; the same on all ranks.
/// @param system  [first rank]
/// @note   Collective on all ranks.
HeldSpectrum held_spectrum(const mbs_export::ReducedSystem& system);

/// The system with the first `n_modes` fixed-interface modes only.
mbs_export::ReducedSystem with_modes(const mbs_export::ReducedSystem& system, int n_modes);

}  // namespace chladni::cli
