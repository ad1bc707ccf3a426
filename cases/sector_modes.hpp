#pragma once

#include <vector>

#include "cases/sector_matrices.hpp"
#include "linear/solver_options.hpp"

/// Natural modes of a body of equal sectors under its supports, harmonic by harmonic.
namespace chladni::cases {

/// A sector with its supports and matrices.
struct SupportedSector {
  SectorModel model;
  cyclic::SectorMatrices matrices;
  std::vector<bool> is_held;  ///< [n_dofs]
};

/// Prepares a sector for the modes of its harmonics.
/// @param scene  its supports hold the sector; none of its rings is an interface
/// @throws chladni::Error for a support that does not turn with the sectors.
SupportedSector supported_sector(const scene::Scene& scene, SectorModel model);

/// Elastic modes of one harmonic, with unit modal mass.
struct ModesOfHarmonic {
  int order;
  Eigen::VectorXd omega = {};  ///< [k] rad/s, ascending
  int multiplicity = 1;        ///< number of modes in the whole body for each one
  /// factor from the squares of one sector to those of all
  double weight = 1.0;
  /// [6 n_nodes x k] of the nodes of the sector's mesh; [0 x 0] without modes
  Eigen::MatrixXd x = {}, y = {};
};

/// The lowest modes of a harmonic; fewer than n if the harmonic has fewer.
/// @param is_free  true: the body has all rigid-body motions, which are left out; false: it has
///                 none
ModesOfHarmonic elastic_modes(const SupportedSector& sector, int order, int n, bool is_free,
                              const linear::SolverOptions& solver);

/// The modes of this rank's harmonics up to omega [rad/s], or the lowest one of all.
/// @note   Collective on all ranks, as are the functions below.
/// @throws chladni::Error on all ranks alike.
std::vector<ModesOfHarmonic> modes_up_to(const SupportedSector& sector, double omega, bool is_free,
                                         const linear::SolverOptions& solver);

/// Collects records of numbers about the modes of all ranks and sorts them by frequency. The first
/// number of a record is the frequency, the second how often the record is repeated, the third the
/// order of the harmonic, by which equal frequencies are sorted.
/// @param own  records of this rank, one after the other
/// @return [n_modes x n_columns]
Eigen::MatrixXd by_frequency(const std::vector<double>& own, Eigen::Index n_columns);

/// The frequencies of all ranks, sorted as by `by_frequency`, rad/s.
Eigen::VectorXd frequencies_of(const std::vector<ModesOfHarmonic>& own);

}  // namespace chladni::cases
