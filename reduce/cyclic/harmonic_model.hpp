#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linear/solver_options.hpp"
#include "reduce/cyclic/harmonic_coordinates.hpp"
#include "reduce/reduction.hpp"

namespace chladni::cyclic {

/// The matrices of the assembled sector.
struct SectorMatrices {
  SparseRows K, M;
  SparseRows C = {}, H = {};  ///< viscous and structural damping, or empty
  /// The ranks that reduce a harmonic together; each has the whole matrices of the sector.
  MPI_Comm comm = PETSC_COMM_SELF;
};

/// Returns true for masters that the support holds; it depends on ring, place and component of
/// `Master`.
using IsHeld = std::function<bool(const Master&)>;

/// A tolerance for the responses of masters to harmonic loads on them in one harmonic, as
/// `reduce::ResponseGoal`.
struct HarmonicGoal {
  double Omega;      ///< end of the range, rad/s
  double tolerance;  ///< of the error of each column of responses, relative to its size
  std::function<bool(const Master&)> is_loaded;
  /// Returns the loads.
  /// @param masters  of the model's rows, in their order
  /// @param held     rows that the support holds, ascending
  std::function<reduce::ResponseLoads(const reduce::ReducedModel& model,
                                      const std::vector<Master>& masters,
                                      const std::vector<int>& held)>
      loads;
};

/// A reduced harmonic of the body. Rows are its masters, then modes in exact pairs.
struct HarmonicModel {
  HarmonicCoordinates coordinates;
  reduce::Method method;       ///< Craig-Bampton if no master is free
  Eigen::MatrixXd K, M, C, H;  ///< of the whole body; C and H empty as the sector's
  Eigen::VectorXd omega;       ///< [n_modes] rad/s
  reduce::Certificate certificate;
  /// The symmetric half, which was factored instead if the sector has a mirror.
  std::optional<HarmonicCoordinates> half;
  reduce::FactoredBody body;
  reduce::CraigBamptonBasis basis;
  std::vector<int> places;  ///< `reduce::coordinate_places`
  /// `ExactPairs::W` of the modes; for a half one column for each pair
  Eigen::MatrixXd W;

  Eigen::Index n_masters() const { return std::ssize(coordinates.masters); }
  const HarmonicCoordinates& solved() const { return half ? *half : coordinates; }
};

/// Reduces one harmonic by the methods of `reduce::reduction`.
/// @param goal  kept by the mixed interface if a master is loaded
/// @note   Collective on the communicator of the sector, as are all functions of this header.
/// @throws chladni::Error as `reduce::factored` and `reduce::reduction`.
HarmonicModel reduce_harmonic(const SectorMatrices& sector, HarmonicCoordinates coordinates,
                              const reduce::ReductionOptions& options, const IsHeld& is_held,
                              reduce::PhaseListener& phases,
                              const std::optional<HarmonicGoal>& goal = std::nullopt);

/// The frequencies of the lowest elastic modes of the method: with all masters held, or, for
/// methods with free masters, with the masters of the support held.
/// @return at least `count` values if there are as many, rad/s, ascending; those of pairs twice
std::vector<double> lowest_frequencies(const SectorMatrices& sector,
                                       const HarmonicCoordinates& coordinates, int count,
                                       const reduce::ReductionOptions& options,
                                       const IsHeld& is_held);

/// The rows of the transformation from the model to some DOFs of the sector.
SectorMotion sector_motion(const HarmonicModel& model, std::span<const int> dofs);

/// Modes in pairs: mode 2 i + 1 is mode 2 i a quarter of a period later.
struct ExactPairs {
  /// [n x n_paired] orthonormal: each paired mode as a combination of the given ones
  Eigen::MatrixXd W;
  /// [n_paired] rad/s, the same for both modes of a pair
  Eigen::VectorXd omega;
};

/// Separates the pairs of modes that a solver returns in any mixture. A mode without its partner is
/// left out.
/// @param omega  [n] ascending, rad/s
/// @param S      [n x n] Phi^T M J Phi, skew: the modes under the quarter-period shift J
ExactPairs exact_pairs(const Eigen::VectorXd& omega, const Eigen::MatrixXd& S);

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
