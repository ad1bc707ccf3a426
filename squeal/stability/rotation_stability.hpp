#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The least stable motion of any sliding disc at one speed (rad/s), axisymmetric or not.
struct RotationGrowth {
  double growth;        ///< 1/s
  double frequency_Hz;  ///< in the frame of the disc, from the energies of the motion
};

/// In the frame of the disc the pads go round, so that its linearised equations have the period of
/// one rotation. Their monodromy matrix is the product of Strang steps over that time, exact modes
/// and linearised pads; growth = ln |mu| / T of its largest eigenvalue mu (Floquet), extrapolated
/// from two step lengths.
RotationGrowth rotation_growth(const Disc& disc, const SquealOptions& options, double speed);

/// The growth over `options.study.speeds` by `options.study.rotation_method`, on `n_threads`
/// threads (0: as many as processors), and the first speed at which it turns positive: Hill's
/// method (see hill.hpp), or `rotation_growth` at each speed, whose cost is that of one rotation
/// for each of the 2 n_modes directions. The growth of the disc that stands still is beside it.
RotationStability rotation_stability(const Disc& disc, const SquealOptions& options,
                                     unsigned n_threads = 0);

/// What the speeds that were looked at say of the range.
Stability stability_of(const RotationStability& rotation);

}  // namespace chladni::squeal
