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
  SparseRows C = {}, H = {};  ///< of dampers and of structural damping, or empty
  /// Of the ranks that reduce a harmonic together; each has the matrices of the sector.
  MPI_Comm comm = PETSC_COMM_SELF;
};

/// Masters that the support holds, as (ring, place, component) of `Master`.
using IsHeld = std::function<bool(const Master&)>;

/// Responses of masters to harmonic loads there, which a harmonic is to keep as
/// `reduce::ResponseGoal` says.
struct HarmonicGoal {
  double Omega;      ///< end of the range, rad/s
  double tolerance;  ///< of the error of each column of responses, over its size
  std::function<bool(const Master&)> is_loaded;
  /// @param masters  of the model's rows, in their order
  /// @param held     rows that the support holds, ascending
  std::function<reduce::ResponseLoads(const reduce::ReducedModel& model,
                                      const std::vector<Master>& masters,
                                      const std::vector<int>& held)>
      loads;
};

/// One harmonic of the body, reduced: rows are its masters, then modes in exact pairs.
struct HarmonicModel {
  HarmonicCoordinates coordinates;
  reduce::Method method;       ///< Craig and Bampton's where there are no masters to be free
  Eigen::MatrixXd K, M, C, H;  ///< of the whole body; C and H as the sector's
  Eigen::VectorXd omega;       ///< [n_modes] rad/s
  reduce::Certificate certificate;
  /// What was factored: the symmetric half, where the sector has a mirror.
  std::optional<HarmonicCoordinates> half;
  reduce::FactoredBody body;
  reduce::CraigBamptonBasis basis;
  std::vector<int> places;  ///< `reduce::coordinate_places`
  Eigen::MatrixXd W;        ///< of the modes, `ExactPairs`; of a half one column for each pair

  Eigen::Index n_masters() const { return std::ssize(coordinates.masters); }
  const HarmonicCoordinates& solved() const { return half ? *half : coordinates; }
};

/// Reduces one harmonic by the methods of `reduce::reduction`, with masters as its masters.
/// @param goal  kept by the mixed interface where a master is loaded
/// @note   Collective on the communicator of the sector, as all of this header.
/// @throws chladni::Error as reduce::factored and reduce::reduction.
HarmonicModel reduce_harmonic(const SectorMatrices& sector, HarmonicCoordinates coordinates,
                              const reduce::ReductionOptions& options, const IsHeld& is_held,
                              reduce::PhaseListener& phases,
                              const std::optional<HarmonicGoal>& goal = std::nullopt);

/// The lowest elastic modes that the method takes: with all masters held or, of methods with free
/// masters, with those of the support. Ascending, in rad/s, those of pairs twice; at least `count`
/// of them.
std::vector<double> lowest_frequencies(const SectorMatrices& sector,
                                       const HarmonicCoordinates& coordinates, int count,
                                       const reduce::ReductionOptions& options,
                                       const IsHeld& is_held);

/// Rows of the transformation from the model to the sector.
SectorMotion sector_motion(const HarmonicModel& model, std::span<const int> dofs);

}  // namespace chladni::cyclic
