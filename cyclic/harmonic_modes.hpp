#pragma once

#include <Eigen/Core>
#include <vector>

#include "cyclic/harmonic_model.hpp"
#include "linear/solver_options.hpp"

namespace chladni::cyclic {

/// Natural modes of one harmonic under a support, of unit modal mass of the whole body.
struct HarmonicModes {
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending; rigid-body motions first, as 0
  int multiplicity;       ///< each stands for so many modes: 2 where a mirror leaves one of a pair
  SectorMotion motion;    ///< [n_dofs x k] of all DOFs of the sector
};

struct HarmonicModesOptions {
  int n_modes;                   ///< of the motions that are solved for, half of them with a mirror
  int n_rigid = 0;               ///< rigid-body motions among these
  linear::SolverOptions solver;  ///< on the communicator of each rank
};

/// The lowest modes of a harmonic, by block Lanczos; fewer where the harmonic has fewer.
/// @param is_held  [n_dofs] of the sector: the same at matching and at mirrored nodes, and of both
///                 components that a turn mixes
/// @throws chladni::Error as reduce::natural_modes.
HarmonicModes harmonic_modes(const SectorMatrices& sector, const HarmonicCoordinates& coordinates,
                             const std::vector<bool>& is_held, const HarmonicModesOptions& options);

}  // namespace chladni::cyclic
