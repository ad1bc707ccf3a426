#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cyclic/harmonic_coordinates.hpp"
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

}  // namespace chladni::cyclic
