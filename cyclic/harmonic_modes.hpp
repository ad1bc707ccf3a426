#pragma once

#include <Eigen/Core>
#include <vector>

#include "cyclic/harmonic_model.hpp"
#include "linear/solver_options.hpp"

namespace chladni::cyclic {

/// Natural modes of one harmonic under a support, with unit modal mass of the whole body.
struct HarmonicModes {
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending; rigid-body motions first, as 0
  /// Number of modes that each one stands for: 2 if a mirror leaves one of a pair.
  int multiplicity;
  SectorMotion motion;  ///< [n_dofs x k] of all DOFs of the sector
};

struct HarmonicModesOptions {
  int n_modes;      ///< number of modes of the solved motions, which are half with a mirror
  int n_rigid = 0;  ///< number of rigid-body motions among these
  linear::SolverOptions solver;  ///< on the communicator of each rank
};

/// The lowest modes of a harmonic, by block Lanczos; fewer if the harmonic has fewer.
/// @param is_held  [n_dofs] of the sector: equal at matching and at mirrored nodes, and for
///                 components that a turn mixes
/// @throws chladni::Error as `reduce::natural_modes`.
HarmonicModes harmonic_modes(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                             const std::vector<bool>& is_held, const HarmonicModesOptions& options);

/// Whether all modes of a harmonic under a support lie above a frequency, in rad/s, by a Cholesky
/// factor of K - omega^2 M, which takes a tenth of the time of a few modes. What lies within a
/// millionth above the frequency counts as below it.
/// @param is_held  as above
bool all_modes_lie_above(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                         const std::vector<bool>& is_held, double omega);

}  // namespace chladni::cyclic
