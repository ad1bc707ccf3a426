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
  const reduce::Blocks& K;
  const reduce::Blocks& M;
  /// For each coordinate of the file its place in the model.
  const std::vector<int>& places;
  double lambda_left_out;  ///< of the fixed-interface modes; infinity where it is not known
};

/// Elastic modes of the supported body up to a frequency, at most `most` of them and one at least.
struct ModeRange {
  double omega_max;  ///< rad/s
  int most;
};

/// What a certificate says before there are errors, and the modes it is about; on every rank.
struct HeldPairs {
  reduce::ReducedPairs pairs;  ///< in the coordinates of the reduced model
  int n_rigid;                 ///< of the free body
};

/// @param system  [first rank] the reduced system in the order of the file
/// @param places  for each coordinate of the file its place in the model
/// @note   Collective on all ranks.
/// @throws chladni::Error when the support does not fit the system.
HeldPairs held_pairs(const mbs_export::ReducedSystem& system, const std::vector<int>& places,
                     const std::vector<std::string>& fixed, const ModeRange& range);

/// A certificate, and what bounds are made of when eigenvalues are counted.
struct Certified {
  mbs_export::Certificate certificate;
  reduce::SmallMatrix residuals = {0, 0};  ///< `ErrorEstimates::inner_products`; empty if not asked
};

/// The error estimates of the supported body's modes.
/// @param system  [first rank] the reduced system in the order of the file
/// @note   Collective on all ranks.
/// @throws chladni::Error when the support does not fit the system.
Certified certify(const mbs_export::ReducedSystem& system, const Reduction& reduction,
                  const std::vector<std::string>& fixed, const ModeRange& range,
                  reduce::Purpose purpose);

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

}  // namespace chladni::cli
