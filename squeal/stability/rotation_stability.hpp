#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// The least stable motion of a sliding disc at one speed; the disc need not be axisymmetric.
struct RotationGrowth {
  double growth;        ///< 1/s
  double frequency_Hz;  ///< in the frame of the disc, from the energies of the motion
};

/// Growth rate at a speed (rad/s) by Floquet's method. In the frame of the disc the pads rotate, so
/// that the linearised equations have the period T of one rotation. Their monodromy matrix is the
/// product of Strang steps with exact modes and linearised pads; growth = ln |mu| / T for its
/// largest eigenvalue mu, extrapolated from two step sizes.
RotationGrowth rotation_growth(const Disc& disc, const SquealOptions& options, double speed);

/// Growth rates over `options.study.speeds` by `options.study.rotation_method`, and the lowest
/// speed with growth: Hill's method (see hill.hpp), or `rotation_growth` at each speed, which
/// integrates one rotation for each of the 2 n_modes directions. The growth of the frozen disc is
/// added for comparison.
/// @param n_threads  0: as many as processors
RotationStability rotation_stability(const Disc& disc, const SquealOptions& options,
                                     unsigned n_threads = 0);

/// Eigenvalues over `options.study.speeds` of a disc that is not axisymmetric: of A_0, the mean
/// over the turn (see Hill::mean_matrix), and of the disc that stands at its worst angle. Neither
/// is the motion of the turning disc: the first is near it where asymmetry is small and not in
/// resonance with the turn, the second is what an analysis without the turn may show.
struct TurningEigenvalues {
  EigenvalueMap mean, frozen;
};
TurningEigenvalues turning_eigenvalues(const Disc& disc, const SquealOptions& options);

/// Classifies the stability over the computed speeds.
Stability stability_of(const RotationStability& rotation);

}  // namespace chladni::squeal
